// Finding a vehicle that is LOST, or has not been found yet: where it may have got to since it was last seen,
// and where it is said to be, is searched, a bounded part a sweep, and what is found must agree with itself
// for some sweeps to be believed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ndt/deadline.hpp"
#include "ndt/fit.hpp"
#include "ndt/found.hpp"
#include "ndt/matcher.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/reach.hpp"
#include "ndt/track.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

struct RecoverySettings {
  std::size_t guesses = 2000;  ///< looked at a sweep, by which cells are occupied; about 2 us each
  FitGates gates;
  /// To be believed, of what matches explained before: a wrong place has half of it.
  double usual_share = 0.85;
  double least_explained = 0.45;  ///< where there was none before
  int agreeing_sweeps = 3;        ///< in a row, after the first two
};

/// What a sweep shows of a vehicle that is LOST.
struct Sighting {
  MatchResult match;       ///< the best
  StampedPose before;      ///< where the sweep before was
  bool confirmed = false;  ///< to be believed
};

/// Neither allocates nor depends on anything but its calls.
class Recovery {
 public:
  explicit Recovery(const RecoverySettings& settings) noexcept
      : settings_(settings), track_(settings.gates) {}

  /// A match was believed.
  void remember(const StampedPose& at, const Velocity& velocity, const MatchResult& match) noexcept;

  /// One sweep while LOST. `prediction`: where the vehicle is, if it stands or another sensor has measured
  /// its motion; `undistorted_with`: by which the points were deskewed; `guess`: where it is said to be.
  /// Before it has ever been seen the guess alone counts. Neither the search nor a match goes on after the
  /// deadline.
  [[nodiscard]] Sighting look(Matcher& matcher, const VoxelMap& map,
                              std::span<const Eigen::Vector3f> points_m, const StampedPose& prediction,
                              const Velocity& undistorted_with, const std::optional<PoseGuess>& guess,
                              const Deadline& deadline) noexcept;

  /// One sweep, where the whole map was searched and the vehicle found up to the sweep before. If it was
  /// undistorted with another velocity than was found, that is for the next.
  [[nodiscard]] Sighting check(Matcher& matcher, const VoxelMap& map,
                               std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                               const Found& found, const Velocity& undistorted_with,
                               const Deadline& deadline) noexcept;

  /// The best guess at the velocity, to undo the next sweep's distortion with.
  [[nodiscard]] const Velocity& velocity() const noexcept {
    return track_.exists() ? track_.velocity() : last_velocity_;
  }

 private:
  static constexpr std::size_t kMatches = 4;  ///< of the best guesses
  struct Ranked {
    std::array<RankedGuess, kMatches> best{};
    std::size_t count = 0;
    void add(const RankedGuess& guess) noexcept;
  };

  void pass_time(std::int64_t stamp_utc_ns) noexcept;
  [[nodiscard]] double least_explained() const noexcept;
  /// What lies around a pose on the ground is ranked; `next_way` leads from it to the next guess.
  template <class NextWay>
  void search(const VoxelMap& map, const Landmarks& landmarks, const Pose& from, std::size_t guesses,
              const Deadline& deadline, Ranked& ranked, NextWay next_way) noexcept;
  void search_on_way(const VoxelMap& map, const Landmarks& landmarks, std::size_t guesses,
                     const Deadline& deadline, Ranked& ranked) noexcept;
  void search_around(const PoseGuess& guess, const VoxelMap& map, const Landmarks& landmarks,
                     std::size_t guesses, const Deadline& deadline, Ranked& ranked) noexcept;

  RecoverySettings settings_;
  bool has_been_seen_ = false;
  Pose last_seen_ = Pose::Identity();
  Velocity last_velocity_ = Velocity::Zero();
  double usual_explained_ = 0.0;  ///< of all points, as well as can be
  std::int64_t last_stamp_utc_ns_ = 0;
  double passed_s_ = 0.0;   ///< since it was last seen
  double counted_s_ = 0.0;  ///< of these, with sweeps that came
  Track track_;
  GuessSequence sequence_;
};

}  // namespace landfix::ndt
