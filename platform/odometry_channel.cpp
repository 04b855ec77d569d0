#include "platform/odometry_channel.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::platform {

bool OdometryChannel::add(std::int64_t stamp_ns, double value) noexcept {
  constexpr std::int64_t kSetBack_ns = 500'000'000;
  if (added_ != 0) {
    const std::int64_t since_ns = stamp_ns - sample(0).stamp_ns;
    if (since_ns < -kSetBack_ns) {
      added_ = 0;  // the clock was set back: what was before has no time any more
    } else if (since_ns <= 0) {
      return false;
    } else if (since_ns <= limits_.timeout_ns) {
      const double allowed = limits_.rate * static_cast<double>(since_ns) * 1e-9 + limits_.slack;
      if (std::abs(value - sample(0).value) > allowed) return false;
    }
  }
  samples_[added_ % kSamples] = {stamp_ns, value};
  ++added_;
  return true;
}

std::optional<double> OdometryChannel::at(std::int64_t stamp_ns) const noexcept {
  const std::size_t count = std::min(added_, kSamples);
  if (count == 0) return std::nullopt;
  if (stamp_ns >= sample(0).stamp_ns) {
    if (stamp_ns - sample(0).stamp_ns > limits_.timeout_ns) return std::nullopt;
    return sample(0).value;
  }
  // The newest that is not later.
  std::size_t later = 0;
  std::size_t beyond = count;
  while (beyond - later > 1) {
    const std::size_t middle = (later + beyond) / 2;
    (sample(middle).stamp_ns > stamp_ns ? later : beyond) = middle;
  }
  if (beyond == count) return std::nullopt;  // older than all of them
  const Sample& before = sample(beyond);
  const Sample& after = sample(later);
  const std::int64_t between_ns = after.stamp_ns - before.stamp_ns;
  if (between_ns > limits_.timeout_ns) return std::nullopt;
  const double share = static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(between_ns);
  return before.value + share * (after.value - before.value);
}

void OdometryChannel::compare(double measured, double matched) noexcept {
  const double tolerance = limits_.tolerance + limits_.tolerance_share * std::abs(matched);
  const double error = measured - matched;
  error_ += kShare * (error - error_);
  agreed_ = std::abs(error) <= 2.0 * tolerance ? agreed_ + 1 : 0;
  if (std::abs(error_) > tolerance) {
    agreed_ = 0;
    if (believed_) ++times_left_out_;
    believed_ = false;
  } else if (agreed_ >= kAgreedSweeps && std::abs(error_) <= 0.5 * tolerance) {
    believed_ = true;
  }
}

}  // namespace landfix::platform
