// A long series as the path of an SVG, as fine as the picture can show it.
#pragma once

#include <span>
#include <string>

namespace landfix::tools {

/// In pixels, x rising: the least and the greatest value of each half pixel, joined by a line that breaks
/// where `longest_gap` pixels have no value. Values that are not finite are left out.
[[nodiscard]] std::string line_path(std::span<const double> x, std::span<const double> y, double longest_gap);

}  // namespace landfix::tools
