#include "platform/pose_frame_decoder.hpp"

#include <algorithm>
#include <bit>

#include "platform/pose_frames.hpp"

namespace landfix::platform {
namespace {

constexpr unsigned kAllSeen = (1U << kClassicPoseFrames) - 1;

bool has_format_of(const FrameLayout& layout, const CanFrame& frame) noexcept {
  return frame.fd == layout.fd && frame.length == layout.length();
}

}  // namespace

PoseFrameDecoder::PoseFrameDecoder(std::uint32_t base_id) noexcept : base_id_(base_id) {
  for (std::size_t i = 0; i < checkers_.size(); ++i) {
    checkers_[i] = E2eChecker(kFrameLayouts[i].profile(), kFrameLayouts[i].data_id());
  }
}

const FrameLayout* PoseFrameDecoder::layout_of(const CanFrame& frame) const noexcept {
  const auto* const layout =
      std::find_if(kFrameLayouts.begin(), kFrameLayouts.end(),
                   [&](const FrameLayout& candidate) { return frame.id == base_id_ + candidate.id_offset; });
  return layout == kFrameLayouts.end() || frame.extended ? nullptr : layout;
}

DecodedFrame PoseFrameDecoder::decode(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept {
  const FrameLayout* const layout = layout_of(frame);
  if (layout == nullptr) return {};
  DecodedFrame result{.layout = layout};
  const auto index = static_cast<std::size_t>(layout - kFrameLayouts.data());
  if (has_format_of(*layout, frame)) result.check = checkers_[index].check(frame.payload());
  if (!is_accepted(result.check.status)) return result;
  result.out_of_order = is_between(index, result.check.counter, stamp_utc_ns);
  if (take_slower(index, frame, result)) return result;
  if (last_utc_ns_ && stamp_utc_ns - *last_utc_ns_ > kTimeout_ns) {
    result.silence_ns = stamp_utc_ns - *last_utc_ns_;
  }
  last_utc_ns_ = stamp_utc_ns;
  latitude_counter_.reset();
  if (index == kFdPoseFrameIndex) {
    decode_frame(*layout, frame.payload(), result.pose.emplace(map_));
  } else {
    add_to_pose(index, frame, stamp_utc_ns, result);
  }
  return result;
}

bool PoseFrameDecoder::take_slower(std::size_t index, const CanFrame& frame, DecodedFrame& result) noexcept {
  if (index == kMapFrameIndex) {
    decode_frame(kFrameLayouts[index], frame.payload(), map_);
  } else if (index == kLatitudeFrameIndex) {
    decode_frame(kFrameLayouts[index], frame.payload(), geodetic_);
    latitude_counter_ = result.check.counter;
  } else if (index == kLongitudeFrameIndex) {
    decode_frame(kFrameLayouts[index], frame.payload(), geodetic_);
    if (latitude_counter_ == result.check.counter) result.geodetic = geodetic_;
  } else {
    return false;
  }
  if (index != kLatitudeFrameIndex) latitude_counter_.reset();
  return true;
}

/// A longitude follows its latitude at once, and what comes less often than poses comes between them.
bool PoseFrameDecoder::is_between(std::size_t index, std::uint8_t counter,
                                  std::int64_t stamp_utc_ns) const noexcept {
  if (index == kLongitudeFrameIndex) return latitude_counter_ != counter;
  if (latitude_counter_) return true;
  const bool is_slower = index == kMapFrameIndex || index == kLatitudeFrameIndex;
  return is_slower && seen_ != 0 && stamp_utc_ns - begun_utc_ns_ <= kLongestPose_ns;
}

void PoseFrameDecoder::add_to_pose(std::size_t index, const CanFrame& frame, std::int64_t stamp_utc_ns,
                                   DecodedFrame& result) noexcept {
  const bool is_of_next =
      result.check.counter != counter_ || has(index) || stamp_utc_ns - begun_utc_ns_ > kLongestPose_ns;
  if (is_of_next) {
    result.frames_missing = frames_missing();
    seen_ = 0;
  }
  if (seen_ == 0) {
    report_ = map_;
    begun_utc_ns_ = stamp_utc_ns;
  }
  counter_ = result.check.counter;
  result.out_of_order |= seen_ >> index != 0;
  seen_ |= 1U << index;
  decode_frame(kFrameLayouts[index], frame.payload(), report_);
  report_.weak = report_.weak_axes != 0 ? 1 : 0;
  if (seen_ == kAllSeen) {
    result.pose = report_;
    seen_ = 0;
  }
}

std::size_t PoseFrameDecoder::frames_missing() const noexcept {
  return seen_ == 0 ? 0 : kClassicPoseFrames - static_cast<std::size_t>(std::popcount(seen_));
}

}  // namespace landfix::platform
