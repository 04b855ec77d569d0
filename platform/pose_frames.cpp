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

void PoseFrameEncoder::add_slower(std::span<const FrameLayout> layouts, const PoseReport& report,
                                  Slower& slower, PoseFrames& result) const noexcept {
  // Poses that are late by a little do not halve the rate.
  constexpr std::int64_t kTolerance_ns = 20'000'000;
  const std::int64_t period_ns = std::int64_t{layouts.front().period_ms} * 1'000'000;
  const std::int64_t now_utc_ns = report.stamp_utc_ns;
  // A clock that was set back does not silence it.
  const bool is_due = !slower.sent_utc_ns || now_utc_ns < *slower.sent_utc_ns ||
                      now_utc_ns - *slower.sent_utc_ns + kTolerance_ns >= period_ns;
  if (!is_due) return;
  for (const FrameLayout& layout : layouts) {
    result.frames[result.count++] = encode_frame(layout, base_id_, slower.counter, report);
  }
  slower.counter = next_e2e_counter(layouts.front().profile(), slower.counter);
  slower.sent_utc_ns = now_utc_ns;
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
  constexpr std::span kLayouts(kFrameLayouts);
  if (is_geodetic_) add_slower(kLayouts.subspan(kLatitudeFrameIndex, 2), sent, geodetic_, result);
  add_slower(kLayouts.subspan(kMapFrameIndex, 1), sent, map_, result);
  return result;
}

}  // namespace landfix::platform
