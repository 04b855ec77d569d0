// Finding the pose of one scan without a guess: where it fits seen from above (PlanSearch), then matched in
// three dimensions, and a verdict on how much that is worth.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ndt/deadline.hpp"
#include "ndt/matcher.hpp"
#include "ndt/plan_points.hpp"
#include "ndt/plan_search.hpp"
#include "ndt/plan_view.hpp"
#include "ndt/pose.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// A pose that a scan may have been taken from.
struct Candidate {
  MatchResult match;
  int plan_score = 0;  ///< see PlanPlace
};

/// What is known of a scan's pose.
struct Location {
  /// The best match first, each elsewhere than all before it; none where nothing fits.
  std::span<const Candidate> candidates;
  double confidence = 0.0;  ///< how often the first of such candidates is right
  bool sure = false;        ///< it may be believed, and in every direction
  bool complete = true;     ///< nothing was left out for want of time or room
};

/// Allocates in its constructor only.
class Relocalizer {
 public:
  /// `plan`, of the same map that is searched, must outlive it. `max_points`: of a scan.
  explicit Relocalizer(const PlanView& plan, std::size_t max_points = Matcher::kMaxPoints);

  /// `points_m`: the filtered scan, frame `vehicle`, free of motion distortion, neighbours near each other.
  /// `area`: where the vehicle is; nothing: anywhere on the map. The candidates hold until the next call.
  [[nodiscard]] Location locate(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                                const std::optional<PoseGuess>& area = std::nullopt,
                                const Deadline& deadline = {}) noexcept;

  /// From a guess, as a sweep that came after one that was located.
  [[nodiscard]] MatchResult match(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                                  const Pose& guess) noexcept {
    return matcher_.match(map, points_m, guess);
  }

  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return search_.memory_bytes() + screener_.memory_bytes() + matcher_.memory_bytes();
  }

  static constexpr std::size_t kMostCandidates = 8;

 private:
  struct Start {
    Pose pose = Pose::Identity();
    int plan_score = 0;
    std::size_t hits = 0;
  };
  static constexpr std::size_t kMostFloors = 6;
  static constexpr std::size_t kMostStarts = PlanSearch::kMostPlaces * kMostFloors;
  static constexpr std::size_t kMostScreened = 48;
  static constexpr std::size_t kScreenPoints = 200;

  void find_starts(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                   std::span<const PlanPlace> places, const std::optional<PoseGuess>& area) noexcept;
  void choose_screen_points(std::span<const Eigen::Vector3f> points_m) noexcept;
  void match_fully(const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                   const Deadline& deadline) noexcept;
  [[nodiscard]] double confidence_in_first() const noexcept;
  void keep(const Candidate& candidate) noexcept;

  const PlanView& plan_;
  PlanPoints plan_points_;
  PlanSearch search_;
  Matcher screener_;  ///< of few points and steps: a wrong place takes many
  Matcher matcher_;
  std::array<Eigen::Vector3f, kScreenPoints> screen_points_m_;
  std::size_t screen_count_ = 0;
  std::array<Start, kMostStarts> starts_{};
  std::size_t start_count_ = 0;
  std::array<Candidate, kMostCandidates + 1> candidates_{};
  std::size_t candidate_count_ = 0;
};

}  // namespace landfix::ndt
