// Where on a plan view a scan fits, and turned by how much: branch and bound over squares of places, from the
// whole map or an area of it, any heading or some.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/deadline.hpp"
#include "ndt/plan_points.hpp"
#include "ndt/plan_view.hpp"
#include "ndt/pose_guess.hpp"

namespace landfix::ndt {

/// One that fits well, and better than its neighbours.
struct PlanPlace {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< frame `map`, of the vehicle
  double yaw_rad = 0.0;
  int score = 0;  ///< sum of the weights that the scan's points meet
};

/// Allocates in its constructor only.
class PlanSearch {
 public:
  /// `plan` must outlive it.
  explicit PlanSearch(const PlanView& plan);

  /// The `most` best places, best first, each 2 m or 9 degrees from all that are better. `area`: that are
  /// looked at; nothing: all. Ends early at the deadline, and then knows the best of what it has seen.
  [[nodiscard]] std::span<const PlanPlace> find(const PlanPoints& points,
                                                const std::optional<PoseGuess>& area, std::size_t most,
                                                const Deadline& deadline) noexcept;

  /// Whether the last search has left nothing out that might fit better than the best.
  [[nodiscard]] bool was_complete() const noexcept { return complete_; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept;

  static constexpr std::int32_t kHeadings = 360;
  static constexpr std::size_t kMostPlaces = 64;
  static constexpr std::size_t kMostNodes = 1 << 17;

 private:
  /// A square of places with one heading. Scores are bounds, but on level 0.
  struct Node {
    std::uint16_t score = 0;
    std::uint16_t heading = 0;
    std::uint16_t x = 0;  ///< of its lower corner [cells]
    std::uint16_t y = 0;
  };
  /// Nodes of the top level that are scored together.
  struct Run {
    std::int32_t x = 0;  ///< of the first [nodes]
    std::int32_t y = 0;
    std::uint64_t wanted = 0;  ///< a bit a node
  };
  struct Headings {
    std::int32_t first = 0;
    std::int32_t count = kHeadings;
  };

  [[nodiscard]] static bool is_better(const Node& a, const Node& b) noexcept;
  [[nodiscard]] static double angle_of(std::int32_t heading) noexcept;
  [[nodiscard]] static Headings headings_of(const std::optional<PoseGuess>& area) noexcept;
  void choose_runs(const std::optional<PoseGuess>& area) noexcept;
  void turn_points(const PlanPoints& points, const Headings& headings) noexcept;
  void score_top(const Headings& headings, const Deadline& deadline) noexcept;
  void keep_node(const Node& node) noexcept;
  [[nodiscard]] Node scored(std::size_t level, Node node) const noexcept;
  void descend(std::size_t level, const Node& node) noexcept;
  void keep_place(const Node& leaf) noexcept;
  /// What does not reach this cannot be among the best.
  [[nodiscard]] std::uint16_t least() const noexcept;

  const PlanView& plan_;
  std::optional<PoseGuess> area_;
  std::vector<Run> all_runs_;  ///< of all nodes with ground
  std::vector<Run> runs_;      ///< of these, what is looked at
  std::size_t run_count_ = 0;
  std::vector<std::int32_t> offsets_;      ///< of the points in a level, a row a heading
  std::vector<std::int32_t> top_offsets_;  ///< in the top rows
  std::size_t points_ = 0;
  std::vector<Node> nodes_;  ///< of the top level, the best so far
  std::size_t node_count_ = 0;
  std::uint16_t cut_score_ = 0;  ///< what was left out of them had no more
  std::array<Node, kMostPlaces + 1> leaves_{};
  std::size_t leaf_count_ = 0;
  std::size_t most_ = kMostPlaces;
  std::array<PlanPlace, kMostPlaces> places_{};
  bool complete_ = true;
};

}  // namespace landfix::ndt
