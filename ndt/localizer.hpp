// The state machine around the matcher: from one pose to the next, and what may be said of each.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "ndt/dead_reckoning.hpp"
#include "ndt/deadline.hpp"
#include "ndt/fit.hpp"
#include "ndt/found.hpp"
#include "ndt/matcher.hpp"
#include "ndt/measured_motion.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/recovery.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// The same numbers everywhere: in files, on the bus, in metrics.
enum class State : std::uint8_t {
  init = 0,       ///< no sweep has been matched yet
  no_data = 1,    ///< the sensor is silent
  lost = 2,       ///< predicted for too long: the pose is not to be used
  predicted = 3,  ///< this sweep could not be matched; the pose is where the motion leads
  degraded = 4,   ///< matched, but the map explains the sweep badly, or does not hold every direction
  tracking = 5,
};
inline constexpr std::array<std::string_view, 6> kStateNames{"INIT",      "NO_DATA",  "LOST",
                                                             "PREDICTED", "DEGRADED", "TRACKING"};
[[nodiscard]] std::string_view to_string(State state) noexcept;

/// Whether a pose of this state is one: PREDICTED, DEGRADED, TRACKING.
[[nodiscard]] constexpr bool is_usable(State state) noexcept { return state >= State::predicted; }

struct LocalizerSettings {
  MatcherSettings matcher;
  FitGates gates;
  /// A match farther from the prediction is not believed; while INIT the pose is the user's and any match is
  /// that no other sensor contradicts.
  double innovation_limit_m = 1.5;
  double innovation_limit_rad = 0.15;
  /// Sooner after the sweep before, in proportion less is believed, down to this share: a packet that comes
  /// twice or out of order at the cut leaves a splinter of a sweep, whose few points may match anywhere.
  double innovation_full_after_s = 0.05;
  double innovation_least_share = 0.07;
  double lost_after_s = 1.0;   ///< of prediction
  double doubt_after_s = 0.3;  ///< without a good match
  /// Over a shorter time the difference of two poses is more noise than velocity.
  double shortest_baseline_s = 0.05;
};

/// A pose and what it is worth.
struct Fix {
  StampedPose at;
  State state = State::init;
  Velocity velocity = Velocity::Zero();
  /// Of the pose, as MatchResult's, with what the motion within the sweep adds.
  Matrix6 covariance = 1e6 * Matrix6::Identity();
  MatchResult match{};
};

/// One sweep after the other. Allocates in its constructor only.
class Localizer {
 public:
  /// The memory that `map` views must outlive it. `initial_pose`: map <- vehicle at the first sweep; nothing:
  /// it is looked for where a guess says, or found by who searches the map.
  Localizer(const VoxelMap& map, const LocalizerSettings& settings, const std::optional<Pose>& initial_pose);

  /// Another map of the same lattice, from the next sweep on.
  void use_map(const VoxelMap& map) noexcept { map_ = map; }

  [[nodiscard]] const VoxelMap& map() const noexcept { return map_; }
  /// Matches once, for nothing but that code and memory are in place.
  void warm_up(std::span<const Eigen::Vector3f> points_m) noexcept {
    (void)matcher_.match(map_, points_m, last_.pose);
  }

  /// Where the vehicle is said to be as the next sweep ends: there it is looked for, if it is, and while
  /// LOST.
  void expect_near(const std::optional<PoseGuess>& guess) noexcept { guess_ = guess; }
  /// Where it was found, as of the sweep before, by who searches the whole map; nothing: it was not.
  void expect_found(const std::optional<Found>& found) noexcept { found_ = found; }
  /// Whether a guess would be of use.
  [[nodiscard]] bool is_searching() const noexcept { return state_ == State::lost || state_ == State::init; }

  /// Whether it would be of use to search the whole map: it is LOST, not found yet, or has had no good match
  /// for so long, or none at all, that it may be elsewhere.
  [[nodiscard]] bool wants_search() const noexcept {
    return is_searching() || unsure_s_ > settings_.doubt_after_s;
  }
  [[nodiscard]] bool has_been_found() const noexcept { return state_ != State::init; }

  /// The last published pose.
  [[nodiscard]] const Pose& pose() const noexcept { return last_.pose; }
  /// The time that it holds for: of the last sweep, or of what was measured since.
  [[nodiscard]] std::int64_t last_stamp_utc_ns() const noexcept { return last_.stamp_utc_ns; }
  /// The velocity to undo the next sweep's distortion with.
  [[nodiscard]] const Velocity& velocity() const noexcept {
    return is_searching() ? recovery_.velocity() : velocity_;
  }

  /// `points_m`: deskewed and filtered, frame `vehicle` at `stamp_utc_ns`, the end of the sweep. Where
  /// stamps do not rise the prediction stands still. `measured`: the motion since `last_stamp_utc_ns`, by
  /// another sensor; else it goes on as it was. `deadline`: of the match; one that it cuts short is not
  /// believed. `undistorted_with`: the velocity by which the points were deskewed; nothing: velocity().
  [[nodiscard]] Fix localize(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                             const std::optional<MeasuredMotion>& measured = std::nullopt,
                             const Deadline& deadline = {},
                             const std::optional<Velocity>& undistorted_with = std::nullopt) noexcept;

  /// What may be said of a sweep that has not come: PREDICTED, LOST or still INIT. Nothing that is known
  /// changes by it: the sweep may only be late.
  [[nodiscard]] Fix predict_missing(
      std::int64_t stamp_utc_ns, const std::optional<MeasuredMotion>& measured = std::nullopt) const noexcept;
  /// NO_DATA: the sensor is silent. The next sweep is looked for where the measured motion leads, else where
  /// the motion had led by `lost_after_s`.
  [[nodiscard]] Fix wait_for_data(std::int64_t stamp_utc_ns,
                                  const std::optional<MeasuredMotion>& measured = std::nullopt) noexcept;

 private:
  void begin_time(std::int64_t stamp_utc_ns) noexcept;
  void learn_period(std::int64_t between_ns) noexcept;
  [[nodiscard]] Pose predicted_pose(std::int64_t stamp_utc_ns,
                                    const std::optional<MeasuredMotion>& measured) const noexcept;
  [[nodiscard]] State next_state(const Fix& fix) const noexcept;
  [[nodiscard]] State state_without_match(std::int64_t stamp_utc_ns) const noexcept;
  [[nodiscard]] Matrix6 predicted_covariance(const DeadReckoning& reckoning, const Pose& pose) const noexcept;
  [[nodiscard]] bool agrees_with_guess(const Pose& pose) const noexcept;
  void take_match(Fix& fix) noexcept;
  [[nodiscard]] bool is_elsewhere(const StampedPose& prediction) const noexcept;
  [[nodiscard]] Sighting look_around(std::span<const Eigen::Vector3f> points_m, const StampedPose& prediction,
                                     const Velocity& undistorted_with, const Deadline& deadline) noexcept;
  void count_doubt(const Fix& fix) noexcept;
  void recover(Fix& fix, const Sighting& sighting) noexcept;
  void stand_still(const Pose& pose) noexcept;

  VoxelMap map_;
  LocalizerSettings settings_;
  Matcher matcher_;
  StampedPose last_;  ///< published, or where the measured motion has led since
  std::int64_t last_sweep_utc_ns_ = 0;
  StampedPose last_matched_;  ///< by a match, TRACKING or DEGRADED
  Velocity velocity_ = Velocity::Zero();
  DeadReckoning reckoning_;
  SweepDistortion distortion_;
  Recovery recovery_;
  std::optional<PoseGuess> guess_;
  std::optional<Found> found_;
  bool has_pose_;                              ///< to match the first sweep at, or it has been matched
  Matrix6 last_covariance_ = Matrix6::Zero();  ///< by a match
  State state_ = State::init;
  double unsure_s_ = std::numeric_limits<double>::infinity();  ///< since a match was good
  std::int64_t period_ns_ = 100'000'000;                       ///< of the sweeps
  bool clock_was_set_ = false;                                 ///< since the last match
  bool any_sweep_ = false;
};

}  // namespace landfix::ndt
