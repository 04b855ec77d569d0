#include "tools/line_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

namespace landfix::tools {

std::string line_path(std::span<const double> x, std::span<const double> y, double longest_gap) {
  constexpr double kStep = 0.5;
  std::string path;
  double last_x = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x.size();) {
    const double from_x = x[i];
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    do {
      if (std::isfinite(y[i])) {
        least = std::min(least, y[i]);
        greatest = std::max(greatest, y[i]);
      }
    } while (++i < x.size() && x[i] <= from_x + kStep);
    if (greatest < least) continue;
    path += fmt::format("{}{:.1f} {:.1f}", from_x - last_x > longest_gap ? 'M' : 'L', from_x, greatest);
    if (greatest > least) path += fmt::format("V{:.1f}", least);
    last_x = from_x;
  }
  return path;
}

}  // namespace landfix::tools
