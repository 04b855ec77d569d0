// The map seen from above: where something stands, and how much it tells to see something stand there. What
// a search over places needs: a byte a square metre, and pyramids of it that bound what a square of places
// can reach (E. Olson, "Real-Time Correlative Scan Matching", ICRA 2009; W. Hess et al., "Real-Time Loop
// Closure in 2D LIDAR SLAM", ICRA 2016).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ndt/ground_grid.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// What is higher above the ground than this stands there, on a map as in a scan.
inline constexpr float kStands_m = 1.0F;

/// Made once from a map, which it does not need afterwards.
class PlanView {
 public:
  /// Takes a look at all voxels: 0.3 s for a city of a square kilometre. Throws as check_width does, and
  /// std::bad_alloc.
  explicit PlanView(const VoxelMap& map);
  /// Throws std::runtime_error that says so where the map is too wide to be seen as a whole.
  static void check_width(const VoxelMap& map);

  /// What is seen from farther away than this, along an axis, is not used.
  static constexpr std::int32_t kMarginCells = 64;
  /// The finest level is 0; a node of level n is a square of 2^n cells of places.
  static constexpr std::size_t kLevels = 3;
  static constexpr std::size_t kTop = kLevels - 1;
  static constexpr std::int32_t kTopCells = 1 << kTop;
  /// Weights are below this, so that 16 of them fit a byte.
  static constexpr std::uint8_t kMostWeight = 15;
  static constexpr double kWeightABit = 4.0;  ///< of Shannon's

  /// Edge of a cell: 1 m, or a voxel's where that is more.
  [[nodiscard]] double cell_m() const noexcept { return cell_m_; }
  /// Cells a side, margins included, in multiples of kTopCells; row by row, x fastest.
  [[nodiscard]] std::int32_t width() const noexcept { return width_; }
  [[nodiscard]] std::int32_t height() const noexcept { return height_; }
  /// The lower corner of cell (0, 0), which is in the margin.
  [[nodiscard]] const Eigen::Vector2d& corner_m() const noexcept { return corner_m_; }

  /// The greatest weight that a point can meet that is seen so many cells away, in whole ones, from anywhere
  /// in the node whose lower corner is that much nearer: of 2^level + 1 cells a side from this one on.
  [[nodiscard]] std::span<const std::uint8_t> level(std::size_t n) const noexcept { return levels_[n]; }

  /// The top level once more, in an order that has the nodes of a row, as one point sees them, side by side.
  [[nodiscard]] const std::uint8_t* top_rows() const noexcept { return top_rows_.data(); }
  /// What a point adds to the place of node (0, 0) in it.
  [[nodiscard]] std::int32_t top_offset(std::int32_t cells_x, std::int32_t cells_y) const noexcept {
    constexpr std::int32_t kPhases = kTopCells - 1;
    const std::int32_t phase = (cells_y & kPhases) * kTopCells + (cells_x & kPhases);
    return (phase * top_nodes_y() + (cells_y >> kTop)) * top_stride_ + (cells_x >> kTop);
  }
  [[nodiscard]] std::int32_t top_stride() const noexcept { return top_stride_; }
  [[nodiscard]] std::int32_t top_nodes_x() const noexcept { return width_ / kTopCells; }
  [[nodiscard]] std::int32_t top_nodes_y() const noexcept { return height_ / kTopCells; }

  /// Whether a vehicle can stand there: the map has ground in the cell.
  [[nodiscard]] bool has_ground(std::int32_t x, std::int32_t y) const noexcept {
    return has_ground_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)] != 0;
  }
  /// Whether it can in any cell of the node of the top level.
  [[nodiscard]] bool top_has_ground(std::int32_t node_x, std::int32_t node_y) const noexcept {
    for (std::int32_t i = 0; i < kTopCells * kTopCells; ++i) {
      if (has_ground(node_x * kTopCells + i % kTopCells, node_y * kTopCells + i / kTopCells)) return true;
    }
    return false;
  }
  [[nodiscard]] float ground_m(const Eigen::Vector2d& place_m) const noexcept {
    return ground_.height_m(place_m);
  }
  /// Square metres of ground.
  [[nodiscard]] double area_m2() const noexcept { return area_m2_; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept;

 private:
  struct Extent {
    Eigen::Vector2d corner_m;
    std::int32_t width = 0;
    std::int32_t height = 0;
  };
  explicit PlanView(const VoxelMap& map, double cell_m, const Extent& extent);
  [[nodiscard]] static Extent extent_of(const Eigen::AlignedBox2d& box, double cell_m);
  void draw(const VoxelMap& map);
  void weigh();
  void build_pyramid();
  void order_top_rows();

  double cell_m_;
  Eigen::Vector2d corner_m_;
  std::int32_t width_;
  std::int32_t height_;
  std::int32_t top_stride_;
  double area_m2_ = 0.0;
  GroundGrid ground_;
  std::vector<std::uint8_t> has_ground_;
  std::array<std::vector<std::uint8_t>, kLevels> levels_;
  std::vector<std::uint8_t> top_rows_;
};

}  // namespace landfix::ndt
