#include "ndt/plan_points.hpp"

#include "ndt/plan_view.hpp"

namespace landfix::ndt {
namespace {

static_assert(128 == 2 * PlanView::kMarginCells,
              "all that is taken stays within the margin, however it turns");
constexpr float kFarthestCells = PlanView::kMarginCells - 2;

}  // namespace

void PlanPoints::take(std::span<const Eigen::Vector3f> points_m) noexcept {
  ground_.clear();
  for (const Eigen::Vector3f& point_m : points_m) ground_.add(point_m.cast<double>());
  ground_.spread();

  constexpr float kHalfField = 0.5F * kFieldCells;
  taken_.fill(0);
  std::size_t standing = 0;
  for (const Eigen::Vector3f& point_m : points_m) {
    const Eigen::Vector2f cell = point_m.head<2>() / static_cast<float>(cell_m_);
    if (!(cell.norm() < kFarthestCells)) continue;
    if (!(point_m.z() > ground_.height_m(point_m.head<2>().cast<double>()) + kStands_m)) continue;
    const auto x = static_cast<std::size_t>(cell.x() + kHalfField);
    const auto y = static_cast<std::size_t>(cell.y() + kHalfField);
    const std::size_t index = y * kFieldCells + x;
    const std::uint64_t bit = std::uint64_t{1} << (index % 64);
    if ((taken_[index / 64] & bit) != 0) continue;
    taken_[index / 64] |= bit;
    standing_[standing++] = cell;
  }
  count_ = std::min(standing, kMost);
  for (std::size_t i = 0; i < count_; ++i) cells_[i] = standing_[i * standing / count_];
}

}  // namespace landfix::ndt
