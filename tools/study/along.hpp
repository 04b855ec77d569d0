// Estimated poses against the true ones, along the way.
#pragma once

#include <span>
#include <vector>

#include "platform/trajectory.hpp"
#include "tools/study/figures.hpp"

namespace landfix::tools::study {

/// Zero of nothing.
[[nodiscard]] Spread spread_of(std::span<const double> values);

/// Where the vehicle truly was.
class Truth {
 public:
  explicit Truth(std::vector<platform::StampedPose> poses);

  [[nodiscard]] std::span<const platform::StampedPose> poses() const noexcept { return poses_; }
  /// Adds a row, unless the truth does not know the time.
  void compare(const platform::StampedPose& estimate, double iterations, Along& along) const;

 private:
  std::vector<platform::StampedPose> poses_;
  std::vector<double> way_m_;  ///< until each
};

[[nodiscard]] double largest(std::span<const double> values);
[[nodiscard]] double root_mean_square(std::span<const double> values);
/// Of estimate and truth.
[[nodiscard]] double largest_elevation_error_m(const Along& along);

}  // namespace landfix::tools::study
