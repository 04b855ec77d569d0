// One quantity that odometry measures, over the last seconds, and whether it is to be believed: it must agree
// with what the matched sweeps say.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace landfix::platform {

/// What a channel allows, in its unit.
struct ChannelLimits {
  double rate = 0.0;             ///< of change, a second; a sample beyond that is a jump
  double slack = 0.0;            ///< that a sample may jump by all the same: steps and noise
  double tolerance = 0.0;        ///< of disagreement with the matched motion, averaged over sweeps
  double tolerance_share = 0.0;  ///< of the value, added to that
  std::int64_t timeout_ns = 0;   ///< from sample to sample; longer is silence
};

/// Takes samples with rising stamps.
class OdometryChannel {
 public:
  explicit OdometryChannel(const ChannelLimits& limits) noexcept : limits_(limits) {}

  /// False if it is a jump, or older than the newest: then it is left out.
  [[nodiscard]] bool add(std::int64_t stamp_ns, double value) noexcept;

  /// Between samples interpolated; after the newest it holds until the time-out. Nothing in a silence.
  [[nodiscard]] std::optional<double> at(std::int64_t stamp_ns) const noexcept;

  /// What it said of a sweep, and what the match did. Left out while the mean disagreement is beyond the
  /// tolerance, taken back when they have agreed over some sweeps; at first it has to earn that.
  void compare(double measured, double matched) noexcept;
  /// There was nothing to compare.
  void miss() noexcept { agreed_ = 0; }

  [[nodiscard]] bool is_believed() const noexcept { return believed_; }
  /// The mean disagreement.
  [[nodiscard]] double error() const noexcept { return error_; }
  [[nodiscard]] std::uint64_t times_left_out() const noexcept { return times_left_out_; }

 private:
  struct Sample {
    std::int64_t stamp_ns = 0;
    double value = 0.0;
  };
  static constexpr std::size_t kSamples = 512;  // 5 s at 100 Hz
  static constexpr double kShare = 0.2;         // of the newest sweep in the mean
  static constexpr int kAgreedSweeps = 10;      // until it is believed

  /// 0: the newest.
  [[nodiscard]] const Sample& sample(std::size_t back) const noexcept {
    return samples_[(added_ - 1 - back) % kSamples];
  }

  ChannelLimits limits_;
  std::array<Sample, kSamples> samples_{};
  std::size_t added_ = 0;
  double error_ = 0.0;
  int agreed_ = 0;  ///< sweeps in a row
  bool believed_ = false;
  std::uint64_t times_left_out_ = 0;
};

}  // namespace landfix::platform
