#include "ndt/plan_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <tuple>

#include "ndt/plan_kernel.hpp"

namespace landfix::ndt {
namespace {

constexpr double kNeighbours_m = 2.0;
constexpr std::int32_t kNeighbourHeadings = 9;
constexpr std::size_t kNodesBetweenLooksAtTheClock = 256;

[[nodiscard]] std::int32_t headings_apart(std::int32_t a, std::int32_t b) noexcept {
  const std::int32_t apart = std::abs(a - b);
  return std::min(apart, PlanSearch::kHeadings - apart);
}

}  // namespace

double PlanSearch::angle_of(std::int32_t heading) noexcept {
  return 2.0 * std::numbers::pi * heading / kHeadings;
}

/// A total order, so that the same scan always finds the same places.
bool PlanSearch::is_better(const Node& a, const Node& b) noexcept {
  return std::tuple(b.score, a.y, a.x, a.heading) < std::tuple(a.score, b.y, b.x, b.heading);
}

std::span<const PlanPlace> PlanSearch::find(const PlanPoints& points, const std::optional<PoseGuess>& area,
                                            std::size_t most, const Deadline& deadline) noexcept {
  area_ = area;
  most_ = std::min(most, kMostPlaces);
  node_count_ = leaf_count_ = 0;
  cut_score_ = 0;
  complete_ = true;
  choose_runs(area);
  const Headings headings = headings_of(area);
  turn_points(points, headings);
  score_top(headings, deadline);
  std::sort(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(node_count_), is_better);
  for (std::size_t i = 0; i < node_count_ && nodes_[i].score > least(); ++i) {
    if (i % kNodesBetweenLooksAtTheClock == 0 && deadline.has_passed()) {
      complete_ = false;
      break;
    }
    descend(PlanView::kTop, nodes_[i]);
  }
  complete_ = complete_ && cut_score_ <= (leaf_count_ > 0 ? leaves_[0].score : 0);
  for (std::size_t i = 0; i < leaf_count_; ++i) {
    const Node& leaf = leaves_[i];
    const Eigen::Vector2d middle = Eigen::Vector2d(leaf.x, leaf.y) + Eigen::Vector2d::Constant(0.5);
    places_[i] = {.position_m = plan_.corner_m() + plan_.cell_m() * middle,
                  .yaw_rad = angle_of(leaf.heading),
                  .score = leaf.score};
  }
  return std::span(places_).first(leaf_count_);
}

PlanSearch::Headings PlanSearch::headings_of(const std::optional<PoseGuess>& area) noexcept {
  if (!area || !area->yaw_rad) return {};
  constexpr double kPer_rad = kHeadings / (2.0 * std::numbers::pi);
  const auto middle = static_cast<std::int32_t>(std::lround(*area->yaw_rad * kPer_rad));
  const auto aside = static_cast<std::int32_t>(std::ceil(PoseGuess::kYawWithin_rad * kPer_rad));
  return {.first = ((middle - aside) % kHeadings + kHeadings) % kHeadings, .count = 2 * aside + 1};
}

/// Of all runs, those that the area touches, with the nodes that it touches.
void PlanSearch::choose_runs(const std::optional<PoseGuess>& area) noexcept {
  run_count_ = 0;
  const double node_m = PlanView::kTopCells * plan_.cell_m();
  for (const Run& run : all_runs_) {
    if (!area) {
      runs_[run_count_++] = run;
      continue;
    }
    const double reach_m = area->within_m + node_m;
    const double y_m = plan_.corner_m().y() + (run.y + 0.5) * node_m;
    if (std::abs(y_m - area->position_m.y()) > reach_m) continue;
    Run part = run;
    for (std::uint64_t rest = run.wanted; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const double x_m = plan_.corner_m().x() + (run.x + i + 0.5) * node_m;
      if ((Eigen::Vector2d(x_m, y_m) - area->position_m).norm() > reach_m) part.wanted &= ~(rest & -rest);
    }
    if (part.wanted != 0) runs_[run_count_++] = part;
  }
}

void PlanSearch::turn_points(const PlanPoints& points, const Headings& headings) noexcept {
  points_ = points.cells().size();
  for (std::int32_t n = 0; n < headings.count; ++n) {
    const std::int32_t heading = (headings.first + n) % kHeadings;
    const Eigen::Rotation2Df turn(static_cast<float>(angle_of(heading)));
    const std::size_t row = static_cast<std::size_t>(heading) * PlanPoints::kMost;
    for (std::size_t i = 0; i < points_; ++i) {
      const Eigen::Vector2f cells = turn * points.cells()[i];
      const auto x = static_cast<std::int32_t>(std::floor(cells.x()));
      const auto y = static_cast<std::int32_t>(std::floor(cells.y()));
      offsets_[row + i] = y * plan_.width() + x;
      top_offsets_[row + i] = plan_.top_offset(x, y);
    }
  }
}

void PlanSearch::score_top(const Headings& headings, const Deadline& deadline) noexcept {
  NodeScores scores;
  for (std::int32_t n = 0; n < headings.count; ++n) {
    if (deadline.has_passed()) {
      complete_ = false;
      return;
    }
    const std::int32_t heading = (headings.first + n) % kHeadings;
    const auto offsets =
        std::span(top_offsets_).subspan(static_cast<std::size_t>(heading) * PlanPoints::kMost, points_);
    for (const Run& run : std::span(runs_).first(run_count_)) {
      const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(run.y) * plan_.top_stride() + run.x;
      score_nodes(plan_.top_rows() + first, offsets, scores);
      for (std::uint64_t rest = run.wanted; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        const std::uint16_t score = scores[static_cast<std::size_t>(i)];
        if (score <= cut_score_) continue;
        keep_node({.score = score,
                   .heading = static_cast<std::uint16_t>(heading),
                   .x = static_cast<std::uint16_t>((run.x + i) * PlanView::kTopCells),
                   .y = static_cast<std::uint16_t>(run.y * PlanView::kTopCells)});
      }
    }
  }
}

/// Where there is no more room, the worse half goes.
void PlanSearch::keep_node(const Node& node) noexcept {
  if (node_count_ == nodes_.size()) {
    const auto middle = nodes_.begin() + static_cast<std::ptrdiff_t>(node_count_ / 2);
    std::nth_element(nodes_.begin(), middle, nodes_.end(), is_better);
    cut_score_ = middle->score;
    node_count_ /= 2;
    if (node.score <= cut_score_) return;
  }
  nodes_[node_count_++] = node;
}

PlanSearch::Node PlanSearch::scored(std::size_t level, Node node) const noexcept {
  const std::uint8_t* const here =
      plan_.level(level).data() + static_cast<std::ptrdiff_t>(node.y) * plan_.width() + node.x;
  const auto offsets =
      std::span(offsets_).subspan(static_cast<std::size_t>(node.heading) * PlanPoints::kMost, points_);
  unsigned score = 0;
  for (const std::int32_t offset : offsets) score += here[offset];
  node.score = static_cast<std::uint16_t>(score);
  return node;
}

/// To the four quarters of a node, the best first.
void PlanSearch::descend(std::size_t level, const Node& node) noexcept {
  if (level == 0) {
    keep_place(node);
    return;
  }
  const std::size_t finer = level - 1;
  const auto half = static_cast<std::uint16_t>(1U << finer);
  std::array<Node, 4> quarters;
  for (std::size_t i = 0; i < quarters.size(); ++i) {
    Node quarter = node;
    if ((i & 1U) != 0) quarter.x = static_cast<std::uint16_t>(node.x + half);
    if ((i & 2U) != 0) quarter.y = static_cast<std::uint16_t>(node.y + half);
    quarters[i] = scored(finer, quarter);
  }
  std::sort(quarters.begin(), quarters.end(), is_better);
  for (const Node& quarter : quarters) {
    if (quarter.score > least()) descend(finer, quarter);
  }
}

std::uint16_t PlanSearch::least() const noexcept {
  return leaf_count_ < most_ ? std::uint16_t{0} : leaves_[most_ - 1].score;
}

void PlanSearch::keep_place(const Node& leaf) noexcept {
  if (!plan_.has_ground(leaf.x, leaf.y)) return;
  const double neighbours_cells = kNeighbours_m / plan_.cell_m();
  const auto are_neighbours = [&leaf, neighbours_cells](const Node& other) {
    return std::hypot(leaf.x - other.x, leaf.y - other.y) < neighbours_cells &&
           headings_apart(leaf.heading, other.heading) < kNeighbourHeadings;
  };
  Node* const begin = leaves_.data();
  Node* end = begin + leaf_count_;
  Node* const place = std::lower_bound(begin, end, leaf, is_better);
  if (std::any_of(begin, place, are_neighbours)) return;
  end = std::remove_if(place, end, are_neighbours);
  std::move_backward(place, end, end + 1);
  *place = leaf;
  leaf_count_ = std::min(static_cast<std::size_t>(end + 1 - begin), most_);
}

std::size_t PlanSearch::memory_bytes() const noexcept {
  return 2 * all_runs_.capacity() * sizeof(Run) + 2 * offsets_.size() * sizeof(std::int32_t) +
         nodes_.size() * sizeof(Node);
}

}  // namespace landfix::ndt
