// Set-up of finding a pose without a guess: the one place where it allocates.
#include <utility>

#include "ndt/plan_kernel.hpp"
#include "ndt/relocalizer.hpp"

namespace landfix::ndt {

GroundGrid::GroundGrid(Eigen::Vector2d corner_m, std::size_t columns_x, std::size_t columns_y)
    : corner_m_(std::move(corner_m)),
      columns_x_(columns_x),
      columns_y_(columns_y),
      height_m_(columns_x * columns_y, std::numeric_limits<float>::infinity()) {}

PlanPoints::PlanPoints(double cell_m)
    : cell_m_(cell_m),
      ground_(Eigen::Vector2d::Constant(-0.5 * kFieldCells * cell_m),
              static_cast<std::size_t>(kFieldCells * cell_m / GroundGrid::kColumn_m),
              static_cast<std::size_t>(kFieldCells * cell_m / GroundGrid::kColumn_m)) {}

PlanSearch::PlanSearch(const PlanView& plan)
    : plan_(plan),
      offsets_(kHeadings * PlanPoints::kMost),
      top_offsets_(kHeadings * PlanPoints::kMost),
      nodes_(kMostNodes) {
  constexpr auto kTogether = static_cast<std::int32_t>(kNodesTogether);
  for (std::int32_t y = 0; y < plan.top_nodes_y(); ++y) {
    for (std::int32_t x = 0; x < plan.top_nodes_x(); ++x) {
      if (!plan.top_has_ground(x, y)) continue;
      const bool begins = all_runs_.empty() || all_runs_.back().y != y || x - all_runs_.back().x >= kTogether;
      if (begins) all_runs_.push_back({.x = x, .y = y});
      all_runs_.back().wanted |= std::uint64_t{1} << (x - all_runs_.back().x);
    }
  }
  runs_.resize(all_runs_.size());
}

Relocalizer::Relocalizer(const PlanView& plan, std::size_t max_points)
    : plan_(plan),
      plan_points_(plan.cell_m()),
      search_(plan),
      screener_({.max_iterations = 8, .sharpen = false}, kScreenPoints),
      matcher_({}, max_points) {}

}  // namespace landfix::ndt
