#include "platform/pose_frames.hpp"

#include <algorithm>

#include "platform/can_signal.hpp"
#include "platform/e2e.hpp"

namespace landfix::platform {
namespace {

bool saturates(std::span<const FrameLayout> layouts, const PoseReport& report) noexcept {
  return std::any_of(layouts.begin(), layouts.end(), [&](const FrameLayout& layout) {
    return std::any_of(layout.signals.begin(), layout.signals.end(),
                       [&](const Signal& signal) { return encode_signal(signal, report).saturated; });
  });
}

}  // namespace

CanFrame encode_frame(const FrameLayout& layout, std::uint32_t base_id, std::uint8_t counter,
                      const PoseReport& report) noexcept {
  CanFrame frame{.id = base_id + layout.id_offset,
                 .fd = layout.fd,
                 .bit_rate_switch = layout.fd,
                 .length = layout.length()};
  const auto data = std::span(frame.data).first(layout.length());
  for (const Signal& signal : layout.signals) put_bits(data, signal.bits, encode_signal(signal, report).raw);
  e2e_protect(layout.profile(), data, layout.data_id(), counter);
  return frame;
}

void decode_frame(const FrameLayout& layout, std::span<const std::byte> payload,
                  PoseReport& report) noexcept {
  for (const Signal& signal : layout.signals) decode_signal(signal, get_bits(payload, signal.bits), report);
}

bool PoseFrameEncoder::is_map_due(std::int64_t stamp_utc_ns) const noexcept {
  constexpr std::int64_t kPeriod_ns = std::int64_t{kFrameLayouts[kMapFrameIndex].period_ms} * 1'000'000;
  // A clock that was set back does not silence it.
  return !map_sent_utc_ns_ || stamp_utc_ns < *map_sent_utc_ns_ ||
         stamp_utc_ns - *map_sent_utc_ns_ >= kPeriod_ns;
}

PoseFrames PoseFrameEncoder::encode(const PoseReport& report) noexcept {
  const std::span<const FrameLayout> layouts = pose_layouts(fd_);
  PoseFrames result{.saturated = saturates(layouts, report)};
  PoseReport sent = report;
  if (result.saturated) sent.saturated = 1;
  for (const FrameLayout& layout : layouts) {
    result.frames[result.count++] = encode_frame(layout, base_id_, counter_, sent);
  }
  counter_ = next_e2e_counter(layouts.front().profile(), counter_);
  if (is_map_due(report.stamp_utc_ns)) {
    constexpr const FrameLayout& kMap = kFrameLayouts[kMapFrameIndex];
    result.frames[result.count++] = encode_frame(kMap, base_id_, map_counter_, sent);
    map_counter_ = next_e2e_counter(kMap.profile(), map_counter_);
    map_sent_utc_ns_ = report.stamp_utc_ns;
  }
  return result;
}

}  // namespace landfix::platform
