// Ground that is taken: rectangles in the horizontal plane.
#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace landfix::tools::simulator {

struct Footprint {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();        ///< unit vector along its length
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Zero();  ///< along the axis, and across

  /// `u` and `v` from -1 to 1 across it.
  [[nodiscard]] Eigen::Vector2d at(double u, double v) const noexcept;
  [[nodiscard]] bool overlaps(const Footprint& other) const noexcept;
};

/// Footprints that do not overlap.
class Layout {
 public:
  /// Takes the footprint unless one that is taken already is in the way.
  [[nodiscard]] bool claim(const Footprint& footprint);

 private:
  std::vector<Footprint> taken_;
};

}  // namespace landfix::tools::simulator
