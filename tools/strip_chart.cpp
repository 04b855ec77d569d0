#include "tools/strip_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "tools/line_path.hpp"
#include "tools/svg.hpp"

namespace landfix::tools {
namespace {

// Pixels.
constexpr double kStripsWidth = 720.0;
constexpr double kStripsLeft = 48.0;
constexpr double kStripsRight = 10.0;
constexpr double kBandTop = 24.0;
constexpr double kBandHeight = 16.0;
constexpr double kStripHeight = 64.0;
constexpr double kStripGap = 34.0;  ///< room for a title
constexpr double kTimeAxisHeight = 36.0;
constexpr double kPlotWidth = kStripsWidth - kStripsLeft - kStripsRight;

/// The time axis.
class TimeAxis {
 public:
  explicit TimeAxis(const StripChart& chart)
      : begin_s_(chart.times_s.empty() ? 0.0 : chart.times_s.front()),
        length_s_(chart.times_s.empty() ? 1.0 : std::max(chart.times_s.back() - begin_s_, 1e-3)) {}

  [[nodiscard]] double x(double time_s) const {
    return kStripsLeft + kPlotWidth * (time_s - begin_s_) / length_s_;
  }
  [[nodiscard]] double length_s() const { return length_s_; }
  [[nodiscard]] double begin_s() const { return begin_s_; }

 private:
  double begin_s_;
  double length_s_;
};

/// Sweeps of one state, from its first to the next stretch's first.
struct Stretch {
  ndt::State state{};
  double left = 0.0;
  double right = 0.0;
};

[[nodiscard]] std::vector<Stretch> stretches_of(const StripChart& chart, const TimeAxis& axis) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < chart.times_s.size(); ++i) {
    const double x = axis.x(chart.times_s[i]);
    if (!stretches.empty()) stretches.back().right = x;
    if (stretches.empty() || stretches.back().state != chart.states[i]) {
      stretches.push_back({chart.states[i], x, x});
    }
  }
  return stretches;
}

[[nodiscard]] double strip_top(std::size_t strip) {
  return kBandTop + kBandHeight + kStripGap + static_cast<double>(strip) * (kStripHeight + kStripGap);
}

void add_states(Svg& svg, const StripChart& chart, const TimeAxis& axis) {
  constexpr double kLeast = 1.5;  // so that one bad sweep is seen
  const double bottom = strip_top(chart.strips.size()) - kStripGap;
  svg.add(R"(<text x="{}" y="{}" class="strip">state</text>)", kStripsLeft, kBandTop - 8.0);
  svg.add(R"(<g id="states">)");
  for (const Stretch& stretch : stretches_of(chart, axis)) {
    const double width = std::max(stretch.right - stretch.left, kLeast);
    svg.add(R"(<rect x="{:.1f}" y="{}" width="{:.1f}" height="{}" fill="{}"><title>{}</title></rect>)",
            stretch.left, kBandTop, width, kBandHeight, colour_of(stretch.state),
            ndt::to_string(stretch.state));
    if (stretch.state == ndt::State::tracking) continue;
    svg.add(R"(<rect x="{:.1f}" y="{}" width="{:.1f}" height="{:.1f}" fill="{}" fill-opacity="0.16"/>)",
            stretch.left, kBandTop + kBandHeight, width, bottom - kBandTop - kBandHeight,
            colour_of(stretch.state));
  }
  svg.add("</g>");
}

[[nodiscard]] std::string path_of(const StripChart& chart, const StripChart::Strip& strip,
                                  const TimeAxis& axis, double top, double limit) {
  constexpr double kGap_pixels = 6.0;  // or ten values
  constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::size_t i = 0; i < chart.times_s.size(); ++i) {
    xs.push_back(axis.x(chart.times_s[i]));
    const double shown = std::clamp(strip.values[i], 0.0, limit);
    // What is not finite is none.
    ys.push_back(top + kStripHeight * (1.0 - (std::isfinite(strip.values[i]) ? shown / limit : kNoValue)));
  }
  return line_path(xs, ys, std::max(kGap_pixels, 10.0 * kPlotWidth / static_cast<double>(xs.size() + 1)));
}

void add_strip(Svg& svg, const StripChart& chart, std::size_t number, const TimeAxis& axis) {
  const StripChart::Strip& strip = chart.strips[number];
  const double top = strip_top(number);
  double greatest = 0.0;
  for (const double value : strip.values) {
    if (std::isfinite(value)) greatest = std::max(greatest, value);
  }
  const double limit = greatest > 0.0 ? nice_above(greatest) : 1.0;
  svg.add(R"(<text x="{}" y="{:.1f}" class="strip">{}</text>)", kStripsLeft, top - 8.0, strip.title);
  for (const double share : {0.0, 0.5, 1.0}) {
    const double y = top + kStripHeight * (1.0 - share);
    svg.add(R"(<path d="M{} {:.1f}h{}" class="grid"/>)", kStripsLeft, y, kPlotWidth);
    svg.add(R"(<text x="{}" y="{:.1f}" text-anchor="end">{:g}</text>)", kStripsLeft - 6.0, y + 4.0,
            share * limit);
  }
  svg.add(R"(<path d="{}" class="line"/>)", path_of(chart, strip, axis, top, limit));
}

void add_axis(Svg& svg, const StripChart& chart, const TimeAxis& axis) {
  const double y = strip_top(chart.strips.size()) - kStripGap + 18.0;
  const double step_s = nice_below(axis.length_s() / 4.0);
  for (double at_s = 0.0; at_s <= axis.length_s(); at_s += step_s) {
    svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:g}{}</text>)",
            axis.x(axis.begin_s() + at_s), y, at_s, at_s == 0.0 ? " s" : "");
  }
}

}  // namespace

std::string_view colour_of(ndt::State state) {
  constexpr std::array<std::string_view, 6> kColours{"#7fb0de", "#8a8781", "#c2242c",
                                                     "#ef8a2c", "#e8bd1f", "#2b9668"};
  return kColours[static_cast<std::size_t>(state)];
}

std::string strip_chart_svg(const StripChart& chart) {
  const TimeAxis axis(chart);
  const double height = strip_top(chart.strips.size()) - kStripGap + kTimeAxisHeight;
  Svg svg;
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" class="chart" viewBox="0 0 {} {}" role="img">)",
          kStripsWidth, height);
  add_states(svg, chart, axis);
  for (std::size_t i = 0; i < chart.strips.size(); ++i) add_strip(svg, chart, i, axis);
  add_axis(svg, chart, axis);
  svg.add("</svg>");
  return svg.take();
}

}  // namespace landfix::tools
