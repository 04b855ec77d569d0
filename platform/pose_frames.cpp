#include "platform/pose_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/e2e.hpp"

namespace landfix::platform {
namespace {

/// Every bit of a frame has one meaning, and none of it is the header's.
constexpr bool fits(const FrameLayout& layout) noexcept {
  std::uint64_t used = (std::uint64_t{1} << 8 * kE2eHeaderBytes) - 1;
  for (const Signal& signal : layout.signals) {
    if (signal.length_bits == 0 || signal.start_bit + signal.length_bits > 64) return false;
    const std::uint64_t bits = ((std::uint64_t{1} << signal.length_bits) - 1) << signal.start_bit;
    if ((used & bits) != 0) return false;
    used |= bits;
  }
  return true;
}
static_assert(std::all_of(kFrameLayouts.begin(), kFrameLayouts.end(), fits));

constexpr std::uint64_t mask(const Signal& signal) noexcept {
  return (std::uint64_t{1} << signal.length_bits) - 1;
}

constexpr std::int64_t not_available(const Signal& signal) noexcept {
  if (signal.is_signed) return -(std::int64_t{1} << (signal.length_bits - 1));
  return static_cast<std::int64_t>(mask(signal));
}

constexpr std::int64_t lowest(const Signal& signal) noexcept {
  return signal.is_signed ? not_available(signal) + 1 : 0;
}

constexpr std::int64_t highest(const Signal& signal) noexcept {
  return signal.is_signed ? -(not_available(signal) + 1) : not_available(signal) - 1;
}

std::uint64_t load(std::span<const std::byte, 8> data) noexcept {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits |= std::to_integer<std::uint64_t>(data[i]) << 8 * i;
  return bits;
}

void store(std::span<std::byte, 8> data, std::uint64_t bits) noexcept {
  for (std::size_t i = 0; i < 8; ++i) data[i] = static_cast<std::byte>(bits >> 8 * i & 0xFF);
}

/// To (-pi, pi].
double wrapped_rad(double angle_rad) noexcept {
  const double wrapped = std::remainder(angle_rad, 2.0 * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

}  // namespace

bool encode_signal(const Signal& signal, double value, std::span<std::byte, 8> data) noexcept {
  const double steps = std::nearbyint(value / signal.scale);  // the default rounding mode: half to even
  const auto low = static_cast<double>(lowest(signal));
  const auto high = static_cast<double>(highest(signal));
  const std::int64_t raw =
      std::isnan(steps) ? not_available(signal) : static_cast<std::int64_t>(std::clamp(steps, low, high));
  const std::uint64_t others = load(data) & ~(mask(signal) << signal.start_bit);
  store(data, others | (static_cast<std::uint64_t>(raw) & mask(signal)) << signal.start_bit);
  return steps < low || steps > high;
}

double decode_signal(const Signal& signal, std::span<const std::byte, 8> data) noexcept {
  const std::uint64_t bits = load(data) >> signal.start_bit & mask(signal);
  const std::uint64_t sign_bit = std::uint64_t{1} << (signal.length_bits - 1);
  const bool negative = signal.is_signed && (bits & sign_bit) != 0;
  const auto raw = static_cast<std::int64_t>(negative ? bits | ~mask(signal) : bits);
  if (raw == not_available(signal)) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(raw) * signal.scale;
}

EncodedFrame encode_frame(const FrameLayout& layout, std::uint32_t base_id, std::uint8_t counter,
                          std::span<const double> values) noexcept {
  EncodedFrame result{.frame = {.id = base_id + layout.id_offset, .length = 8}};
  const std::size_t count = std::min(values.size(), layout.signals.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (encode_signal(layout.signals[i], values[i], result.frame.data)) result.saturated = true;
  }
  e2e_protect(result.frame.data, layout.data_id(), counter);
  return result;
}

PoseFrames PoseFrameEncoder::encode(const ndt::Pose& pose) noexcept {
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(pose.linear());
  const std::array position{pose.translation().x(), pose.translation().y()};
  const std::array attitude{wrapped_rad(angles.yaw_rad), angles.pitch_rad, wrapped_rad(angles.roll_rad)};
  const EncodedFrame a = encode_frame(kPositionFrame, base_id_, counter_, position);
  const EncodedFrame b = encode_frame(kAttitudeFrame, base_id_, counter_, attitude);
  counter_ = next_e2e_counter(counter_);
  return {.frames = {a.frame, b.frame}, .saturated = a.saturated || b.saturated};
}

}  // namespace landfix::platform
