// Drawing the map from above: all of it is set-up.
#include "ndt/plan_view.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "ndt/lattice.hpp"

namespace landfix::ndt {
namespace {

constexpr double kFinestCell_m = 1.0;
constexpr double kMostCells = 1 << 25;  // 33.5 km^2 of 1 m: 170 MB
constexpr double kMostCellsAside = 1 << 16;
/// Around a cell: how often something stands there says how little another thing tells.
constexpr std::int32_t kNeighbourhoodCells = 16;
/// Nodes that are read together reach beyond the last.
constexpr std::size_t kReadBeyond = 128;

/// How many of the cells of a rectangle are marked, for any rectangle at once (Crow, 1984).
class SummedAreas {
 public:
  SummedAreas(std::span<const std::uint8_t> marks, std::int32_t width, std::int32_t height)
      : width_(width), height_(height), sums_((to_index(width) + 1) * (to_index(height) + 1)) {
    for (std::int32_t y = 0; y < height; ++y) {
      std::uint32_t row = 0;
      for (std::int32_t x = 0; x < width; ++x) {
        row += marks[to_index(y) * to_index(width) + to_index(x)] != 0 ? 1U : 0U;
        at(x + 1, y + 1) = at(x + 1, y) + row;
      }
    }
  }

  /// Of the square that reaches so far from a cell to each side.
  [[nodiscard]] double around(std::int32_t x, std::int32_t y, std::int32_t reach) {
    const std::int32_t x0 = std::max(x - reach, 0);
    const std::int32_t y0 = std::max(y - reach, 0);
    const std::int32_t x1 = std::min(x + reach + 1, width_);
    const std::int32_t y1 = std::min(y + reach + 1, height_);
    return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
  }

 private:
  [[nodiscard]] static std::size_t to_index(std::int32_t value) { return static_cast<std::size_t>(value); }
  [[nodiscard]] std::uint32_t& at(std::int32_t x, std::int32_t y) {
    return sums_[to_index(y) * (to_index(width_) + 1) + to_index(x)];
  }

  std::int32_t width_;
  std::int32_t height_;
  std::vector<std::uint32_t> sums_;
};

[[nodiscard]] double cell_for(const VoxelMap& map) { return std::max(kFinestCell_m, map.resolution_m()); }

/// Of its blocks, as there are far fewer of them than voxels.
[[nodiscard]] Eigen::AlignedBox2d box_around(const VoxelMap& map) {
  constexpr int kBlockCells = 4;
  Eigen::AlignedBox2d box;
  for (const BlockEntry& block : map.blocks()) {
    if (block.occupancy == 0) continue;
    const Cell corner = block_corner(block.key);
    box.extend(map.resolution_m() * Eigen::Vector2d(corner.i, corner.j));
    box.extend(map.resolution_m() * Eigen::Vector2d(corner.i + kBlockCells, corner.j + kBlockCells));
  }
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  return box;
}

[[nodiscard]] std::size_t columns_over(std::int32_t cells, double cell_m) {
  return static_cast<std::size_t>(cells * cell_m / GroundGrid::kColumn_m) + 1;
}

}  // namespace

PlanView::PlanView(const VoxelMap& map)
    : PlanView(map, cell_for(map), extent_of(box_around(map), cell_for(map))) {}

void PlanView::check_width(const VoxelMap& map) { (void)extent_of(box_around(map), cell_for(map)); }

PlanView::PlanView(const VoxelMap& map, double cell_m, const Extent& extent)
    : cell_m_(cell_m),
      corner_m_(extent.corner_m),
      width_(extent.width),
      height_(extent.height),
      top_stride_(extent.width / kTopCells),
      ground_(corner_m_, columns_over(width_, cell_m), columns_over(height_, cell_m)),
      has_ground_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
  draw(map);
  weigh();
  build_pyramid();
  order_top_rows();
}

PlanView::Extent PlanView::extent_of(const Eigen::AlignedBox2d& box, double cell_m) {
  const Eigen::Array2d first = (box.min() / cell_m).array().floor() - kMarginCells;
  const Eigen::Array2d last = (box.max() / cell_m).array().floor() + kMarginCells + 1;
  const Eigen::Array2d cells = ((last - first) / kTopCells).ceil() * kTopCells;
  if (cells.prod() > kMostCells || cells.maxCoeff() > kMostCellsAside) {
    throw std::runtime_error(
        fmt::format("the map is {:.0f} m x {:.0f} m wide, too wide to be searched as a whole",
                    cells.x() * cell_m, cells.y() * cell_m));
  }
  return {.corner_m = first.matrix() * cell_m,
          .width = static_cast<std::int32_t>(cells.x()),
          .height = static_cast<std::int32_t>(cells.y())};
}

/// Marks the cells where something stands, in level 0, and those where there is ground.
void PlanView::draw(const VoxelMap& map) {
  ground_.clear();
  visit_voxels(map, [this](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) { ground_.add(mean_m); });
  ground_.spread();
  levels_[0].resize(has_ground_.size());
  visit_voxels(map, [this](const Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
    const Eigen::Vector2d cell = (mean_m.head<2>() - corner_m_) / cell_m_;
    const auto index = static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(cell.x());
    const double height_m = mean_m.z() - static_cast<double>(ground_.height_m(mean_m.head<2>()));
    (height_m > static_cast<double>(kStands_m) ? levels_[0] : has_ground_)[index] = 1;
  });
  area_m2_ = static_cast<double>(std::ranges::count(has_ground_, 1)) * cell_m_ * cell_m_;
}

/// A cell in which something stands weighs by how surprising that is among its neighbours that were seen, and
/// no more than on the whole map: at the edge of one, where little was seen, a wall would else outweigh a
/// street.
void PlanView::weigh() {
  std::vector<std::uint8_t>& weights = levels_[0];
  std::vector<std::uint8_t> seen(weights.size());
  std::ranges::transform(weights, has_ground_, seen.begin(), std::bit_or{});
  SummedAreas standing(weights, width_, height_);
  SummedAreas all(seen, width_, height_);
  const double share_of_all =
      static_cast<double>(std::ranges::count(weights, 1)) / static_cast<double>(std::ranges::count(seen, 1));
  for (std::int32_t y = 0; y < height_; ++y) {
    for (std::int32_t x = 0; x < width_; ++x) {
      std::uint8_t& weight = weights[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                     static_cast<std::size_t>(x)];
      if (weight == 0) continue;
      const double share_here =
          standing.around(x, y, kNeighbourhoodCells) / all.around(x, y, kNeighbourhoodCells);
      const double share = std::max(share_here, share_of_all);
      weight = static_cast<std::uint8_t>(
          std::clamp(std::round(-kWeightABit * std::log2(share)), 1.0, static_cast<double>(kMostWeight)));
    }
  }
}

void PlanView::build_pyramid() {
  const auto width = static_cast<std::size_t>(width_);
  const auto height = static_cast<std::size_t>(height_);
  // Of four squares that lie so far apart, each cell of `coarse` the greatest; may be `fine` itself.
  const auto widen = [width, height](const std::vector<std::uint8_t>& fine, std::vector<std::uint8_t>& coarse,
                                     std::size_t apart) {
    for (std::size_t y = 0; y < height; ++y) {
      const std::size_t below = y * width;
      const std::size_t above = std::min(y + apart, height - 1) * width;
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t right = std::min(x + apart, width - 1);
        coarse[below + x] =
            std::max({fine[below + x], fine[below + right], fine[above + x], fine[above + right]});
      }
    }
  };
  widen(levels_[0], levels_[0], 1);
  for (std::size_t n = 1; n < kLevels; ++n) {
    levels_[n].resize(levels_[0].size());
    widen(levels_[n - 1], levels_[n], std::size_t{1} << (n - 1));
  }
}

void PlanView::order_top_rows() {
  top_rows_.resize(levels_[kTop].size() + kReadBeyond);
  for (std::int32_t y = 0; y < height_; ++y) {
    for (std::int32_t x = 0; x < width_; ++x) {
      const std::size_t from =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      top_rows_[static_cast<std::size_t>(top_offset(x, y))] = levels_[kTop][from];
    }
  }
}

std::size_t PlanView::memory_bytes() const noexcept {
  return has_ground_.size() + kLevels * levels_[0].size() + top_rows_.size();
}

}  // namespace landfix::ndt
