// Finding a vehicle again that is LOST, without help: where it may have got to since it was last seen is
// searched, a bounded part a sweep, and what is found must agree with itself for some sweeps to be believed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ndt/deadline.hpp"
#include "ndt/matcher.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"
#include "ndt/reach.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

struct RecoverySettings {
  std::size_t guesses = 2000;  ///< looked at a sweep, by which cells are occupied; about 2 us each
  double good_likelihood = 0.55;
  double good_matched_share = 0.5;
  /// Of the likelihood that matches had before: what a wrong place seldom has.
  double usual_share = 0.85;
  int agreeing_sweeps = 3;  ///< in a row, after the first two
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
  explicit Recovery(const RecoverySettings& settings) noexcept : settings_(settings) {}

  /// A match was believed.
  void remember(const StampedPose& at, const Velocity& velocity, const MatchResult& match) noexcept;

  /// One sweep while LOST. `prediction`: where the vehicle is, if it stands or another sensor has measured
  /// its motion. Neither the search nor a match goes on after the deadline.
  [[nodiscard]] Sighting look(Matcher& matcher, const VoxelMap& map,
                              std::span<const Eigen::Vector3f> points_m, const StampedPose& prediction,
                              const Deadline& deadline) noexcept;

  /// The best guess at the velocity, to undo the next sweep's distortion with.
  [[nodiscard]] const Velocity& velocity() const noexcept { return velocity_; }

 private:
  /// What has been seen and may be it.
  struct Track {
    StampedPose at;
    double likelihood = 0.0;
    int sweeps = 0;  ///< 0: there is none
    int agreeing = 0;
  };
  static constexpr std::size_t kMatches = 4;  ///< of the best guesses
  struct Ranked {
    std::array<RankedGuess, kMatches> best{};
    std::size_t count = 0;
    void add(const RankedGuess& guess) noexcept;
  };

  void pass_time(std::int64_t stamp_utc_ns) noexcept;
  void drop_track() noexcept;
  [[nodiscard]] bool is_good(const MatchResult& match) const noexcept;
  [[nodiscard]] bool follow(const MatchResult& match, const StampedPose& expected) noexcept;
  [[nodiscard]] Ranked search(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                              const Deadline& deadline) noexcept;

  RecoverySettings settings_;
  Pose last_seen_ = Pose::Identity();
  Velocity last_velocity_ = Velocity::Zero();
  double usual_likelihood_ = 0.0;  ///< of the best there can be; 0: unknown
  Velocity velocity_ = Velocity::Zero();
  std::int64_t last_stamp_utc_ns_ = 0;
  double passed_s_ = 0.0;   ///< since it was last seen
  double counted_s_ = 0.0;  ///< of these, with sweeps that came
  Track track_;
  GuessSequence sequence_;
};

}  // namespace landfix::ndt
