#include "ndt/ground_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace landfix::ndt {

void GroundGrid::clear() noexcept { std::ranges::fill(height_m_, std::numeric_limits<float>::infinity()); }

std::size_t GroundGrid::column_of(const Eigen::Vector2d& place_m) const noexcept {
  const Eigen::Vector2d columns = (place_m - corner_m_) / kColumn_m;
  const bool inside = columns.x() >= 0.0 && columns.x() < static_cast<double>(columns_x_) &&
                      columns.y() >= 0.0 && columns.y() < static_cast<double>(columns_y_);
  if (!inside) return kBeyond;
  return static_cast<std::size_t>(columns.y()) * columns_x_ + static_cast<std::size_t>(columns.x());
}

void GroundGrid::add(const Eigen::Vector3d& point_m) noexcept {
  const std::size_t column = column_of(point_m.head<2>());
  if (column == kBeyond) return;
  height_m_[column] = std::min(height_m_[column], static_cast<float>(point_m.z()));
}

float GroundGrid::height_m(const Eigen::Vector2d& place_m) const noexcept {
  const std::size_t column = column_of(place_m);
  return column == kBeyond ? std::numeric_limits<float>::infinity() : height_m_[column];
}

/// A distance transform in two passes (Borgefors, "Distance transformations in digital images", 1986).
void GroundGrid::spread() noexcept {
  constexpr auto kStraight_m = kSteepest * static_cast<float>(kColumn_m);
  constexpr auto kDiagonal_m = kStraight_m * std::numbers::sqrt2_v<float>;
  const auto lower = [this](std::size_t column, std::size_t neighbour, float rise_m) {
    height_m_[column] = std::min(height_m_[column], height_m_[neighbour] + rise_m);
  };
  for (std::size_t y = 0; y < columns_y_; ++y) {
    for (std::size_t x = 0; x < columns_x_; ++x) {
      const std::size_t here = y * columns_x_ + x;
      if (x > 0) lower(here, here - 1, kStraight_m);
      if (y == 0) continue;
      lower(here, here - columns_x_, kStraight_m);
      if (x > 0) lower(here, here - columns_x_ - 1, kDiagonal_m);
      if (x + 1 < columns_x_) lower(here, here - columns_x_ + 1, kDiagonal_m);
    }
  }
  for (std::size_t y = columns_y_; y-- > 0;) {
    for (std::size_t x = columns_x_; x-- > 0;) {
      const std::size_t here = y * columns_x_ + x;
      if (x + 1 < columns_x_) lower(here, here + 1, kStraight_m);
      if (y + 1 == columns_y_) continue;
      lower(here, here + columns_x_, kStraight_m);
      if (x > 0) lower(here, here + columns_x_ - 1, kDiagonal_m);
      if (x + 1 < columns_x_) lower(here, here + columns_x_ + 1, kDiagonal_m);
    }
  }
}

}  // namespace landfix::ndt
