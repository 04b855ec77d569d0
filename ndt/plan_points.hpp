// What stands around a vehicle, seen from above: of a scan what PlanView is of the map.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ndt/ground_grid.hpp"

namespace landfix::ndt {

/// Allocates in its constructor only.
class PlanPoints {
 public:
  /// `cell_m`: of the plan view.
  explicit PlanPoints(double cell_m);

  /// `points_m`: frame `vehicle`, filtered, neighbours near each other. A stretch of a wall counts once,
  /// however high it is and however many points it has.
  void take(std::span<const Eigen::Vector3f> points_m) noexcept;

  /// In cells from the vehicle; spread evenly over the scan.
  [[nodiscard]] std::span<const Eigen::Vector2f> cells() const noexcept {
    return std::span(cells_).first(count_);
  }

  /// More would tell little more.
  static constexpr std::size_t kMost = 240;

 private:
  static constexpr std::size_t kFieldCells = 128;  ///< a side, around the vehicle

  double cell_m_;
  GroundGrid ground_;
  std::array<std::uint64_t, kFieldCells * kFieldCells / 64> taken_{};
  std::array<Eigen::Vector2f, kFieldCells * kFieldCells> standing_;
  std::array<Eigen::Vector2f, kMost> cells_;
  std::size_t count_ = 0;
};

}  // namespace landfix::ndt
