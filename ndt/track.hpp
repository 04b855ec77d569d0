// A place that a sweep was seen to fit, and that the sweeps after it must fit too, where the motion leads,
// for it to be believed: a false one jumps about.
#pragma once

#include <cstdint>

#include "ndt/fit.hpp"
#include "ndt/matcher.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt {

/// Neither allocates nor depends on anything but its calls.
class Track {
 public:
  explicit Track(const FitGates& gates) noexcept : gates_(gates) {}

  [[nodiscard]] bool exists() const noexcept { return sweeps_ != 0; }
  /// Where it was seen last, and how much the map explained there.
  [[nodiscard]] const StampedPose& at() const noexcept { return at_; }
  [[nodiscard]] double explained() const noexcept { return explained_; }
  /// Sweeps in a row, the first two not among them, that were where they should be.
  [[nodiscard]] int agreeing() const noexcept { return agreeing_; }
  /// A guess, until a second sweep has shown it.
  [[nodiscard]] const Velocity& velocity() const noexcept { return velocity_; }
  [[nodiscard]] Pose expected_at(std::int64_t stamp_utc_ns) const noexcept {
    return predict(at_, velocity_, stamp_utc_ns);
  }
  /// Too soon after the last to be a sweep.
  [[nodiscard]] bool is_splinter(std::int64_t stamp_utc_ns) const noexcept;

  /// `velocity`: a guess. `undistorted_with`: the velocity by which the sweep was deskewed.
  void begin(const StampedPose& at, double explained, const Velocity& velocity,
             const Velocity& undistorted_with) noexcept;
  void drop() noexcept { sweeps_ = agreeing_ = 0; }
  /// The match of the next sweep: where that does not have it again, it is dropped. `least_explained`: of
  /// what agrees.
  void follow(const MatchResult& match, const StampedPose& expected, const Velocity& undistorted_with,
              double least_explained) noexcept;

 private:
  FitGates gates_;
  StampedPose at_;
  double explained_ = 0.0;
  int sweeps_ = 0;
  int agreeing_ = 0;
  Velocity velocity_ = Velocity::Zero();
  Velocity first_undistorted_with_ = Velocity::Zero();
};

}  // namespace landfix::ndt
