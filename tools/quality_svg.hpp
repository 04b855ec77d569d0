// A point map seen from above, coloured by how crisp it is.
#pragma once

#include <span>
#include <string>

#include "tools/quality_run.hpp"

namespace landfix::tools {

/// An SVG of at most 4 MB: on top the entropy, below it the plane variance, each the mean of a cell's points.
[[nodiscard]] std::string quality_svg(std::span<const JudgedPoint> points);

}  // namespace landfix::tools
