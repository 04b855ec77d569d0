// How the points of a cell scatter: sums of products, exact, and the entropy that they give.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "ndt/cell_batch.hpp"

namespace landfix::ndt {

/// Sums over a cell's points of the products of their places in it: xx xy xz yy yz zz [2^-28 of its edge^2].
using CellMoments = std::array<std::uint64_t, 6>;

inline void add_point(CellMoments& moments, const Place& place) noexcept {
  const std::uint64_t x = place[0];
  const std::uint64_t y = place[1];
  const std::uint64_t z = place[2];
  const CellMoments products{x * x, x * y, x * z, y * y, y * z, z * z};
  for (std::size_t i = 0; i < products.size(); ++i) moments[i] += products[i];
}

/// Fewer points say nothing of a surface.
inline constexpr std::uint32_t kLeastPointsOfEntropy = 6;

/// Differential entropy of the normal distribution of a cell's points, range noise added [nat, of metres]: a
/// term of the mean map entropy. NaN for fewer than kLeastPointsOfEntropy points. `mean_place`: of the points
/// in the cell [its edge].
[[nodiscard]] float entropy_of(const CellMoments& moments, const Eigen::Vector3d& mean_place,
                               std::uint32_t points, double leaf_m) noexcept;

}  // namespace landfix::ndt
