#include "tools/simulator/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::tools::simulator {
namespace {

Eigen::Vector2d across(const Footprint& footprint) { return {-footprint.axis.y(), footprint.axis.x()}; }

double half_extent_m(const Footprint& footprint, const Eigen::Vector2d& direction) {
  return footprint.half_size_m.x() * std::abs(footprint.axis.dot(direction)) +
         footprint.half_size_m.y() * std::abs(across(footprint).dot(direction));
}

}  // namespace

Eigen::Vector2d Footprint::at(double u, double v) const noexcept {
  return centre_m + u * half_size_m.x() * axis + v * half_size_m.y() * across(*this);
}

bool Footprint::overlaps(const Footprint& other) const noexcept {
  // Separating axes: two convex shapes are apart if some side's direction shows a gap.
  const Eigen::Vector2d apart_m = other.centre_m - centre_m;
  const auto touch_along = [&](const Eigen::Vector2d& direction) {
    return std::abs(apart_m.dot(direction)) <
           half_extent_m(*this, direction) + half_extent_m(other, direction);
  };
  return touch_along(axis) && touch_along(across(*this)) && touch_along(other.axis) &&
         touch_along(across(other));
}

bool Layout::claim(const Footprint& footprint) {
  if (std::ranges::any_of(taken_, [&](const Footprint& other) { return footprint.overlaps(other); })) {
    return false;
  }
  taken_.push_back(footprint);
  return true;
}

}  // namespace landfix::tools::simulator
