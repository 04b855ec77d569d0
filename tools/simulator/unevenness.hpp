// What keeps ground from being flat: a few waves, each with its own direction.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace landfix::tools::simulator {

struct Wave {
  double amplitude_m;
  double length_m;
  double direction_rad;
};

/// Height of the sum of `waves` at a place; each phase gives other ground.
template <std::size_t N>
[[nodiscard]] double unevenness_m(const std::array<Wave, N>& waves, double x_m, double y_m,
                                  double phase_rad) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    const double along_m = x_m * std::cos(waves[i].direction_rad) + y_m * std::sin(waves[i].direction_rad);
    sum_m += waves[i].amplitude_m * std::sin(2.0 * std::numbers::pi * along_m / waves[i].length_m +
                                             phase_rad * static_cast<double>(i + 1));
  }
  return sum_m;
}

}  // namespace landfix::tools::simulator
