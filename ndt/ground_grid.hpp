// Where the ground is, in columns of some metres: the lowest that was seen in each, or what the columns
// around it allow where only a wall or a roof was.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace landfix::ndt {

/// Allocates in its constructor only.
class GroundGrid {
 public:
  /// `corner_m`: the lowest x and y of its columns.
  GroundGrid(Eigen::Vector2d corner_m, std::size_t columns_x, std::size_t columns_y);

  void clear() noexcept;
  /// What is beyond it is left out.
  void add(const Eigen::Vector3d& point_m) noexcept;
  /// Once all have been added: nowhere is the ground steeper than kSteepest.
  void spread() noexcept;

  /// Infinity beyond the grid, and everywhere before anything has been added.
  [[nodiscard]] float height_m(const Eigen::Vector2d& place_m) const noexcept;

  static constexpr double kColumn_m = 4.0;
  static constexpr float kSteepest = 0.25F;

 private:
  static constexpr std::size_t kBeyond = std::numeric_limits<std::size_t>::max();
  [[nodiscard]] std::size_t column_of(const Eigen::Vector2d& place_m) const noexcept;

  Eigen::Vector2d corner_m_;
  std::size_t columns_x_;
  std::size_t columns_y_;
  std::vector<float> height_m_;
};

}  // namespace landfix::ndt
