// What happened along the way, as strips over one axis of time: the state on top, values below it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ndt/localizer.hpp"

namespace landfix::tools {

struct StripChart {
  struct Strip {
    std::string title;
    std::vector<double> values;  ///< one for each time; NaN: none
  };

  std::vector<double> times_s;  ///< rising
  std::vector<ndt::State> states;
  std::vector<Strip> strips;
};

/// As CSS: the colour of a state in every picture.
[[nodiscard]] std::string_view colour_of(ndt::State state);

/// An SVG of at most 100 KB a strip however long the drive; where many values fall onto a pixel it shows the
/// least and the greatest. Its texts and lines have the colours of the page, CSS's currentColor.
[[nodiscard]] std::string strip_chart_svg(const StripChart& chart);

}  // namespace landfix::tools
