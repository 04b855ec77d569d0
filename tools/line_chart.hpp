// Several series over one axis.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace landfix::tools {

struct LineChart {
  struct Line {
    std::string name;  ///< shown in the key; empty: not there
    std::string_view colour;
    std::vector<double> x;  ///< rising
    std::vector<double> y;  ///< as many; NaN: none
  };

  std::string title;
  std::string_view x_unit;
  std::string_view y_unit;
  std::vector<Line> lines;  ///< the last one is drawn on top
};

/// Colours that are told apart, also by those who see no red or green (P. Tol's "muted", and grey).
[[nodiscard]] std::string_view line_colour(std::size_t line);

/// An SVG of at most some 30 KB a line however long the series. Its texts and grid have the colours of the
/// page, CSS's currentColor and classes.
[[nodiscard]] std::string line_chart_svg(const LineChart& chart);

}  // namespace landfix::tools
