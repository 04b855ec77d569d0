#include "tools/line_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "tools/html_page.hpp"
#include "tools/line_path.hpp"
#include "tools/svg.hpp"

namespace landfix::tools {
namespace {

// Pixels.
constexpr double kChartWidth = 720.0;
constexpr double kPlotLeft = 56.0;
constexpr double kPlotRight = 12.0;
constexpr double kPlotTop = 30.0;
constexpr double kPlotHeight = 240.0;
constexpr double kKeyTop = kPlotTop + kPlotHeight + 40.0;
constexpr double kKeyRow = 18.0;
constexpr double kKeyColumn = 160.0;

/// From a round number to a round number.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double step = 1.0;

  [[nodiscard]] double share(double value) const { return (value - low) / (high - low); }
};

[[nodiscard]] Axis axis_over(std::span<const LineChart::Line> lines,
                             std::vector<double> LineChart::Line::*values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const LineChart::Line& line : lines) {
    for (const double value : line.*values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) return {};
  const double least = 1e-3 * std::max(1.0, std::abs(high));  // of a line that is level
  const double step = nice_above(std::max(high - low, least) / 6.0);
  low = step * std::floor(low / step);
  return {.low = low, .high = std::max(step * std::ceil(high / step), low + step), .step = step};
}

[[nodiscard]] double x_of(const Axis& axis, double value) {
  return kPlotLeft + (kChartWidth - kPlotLeft - kPlotRight) * axis.share(value);
}
[[nodiscard]] double y_of(const Axis& axis, double value) {
  return kPlotTop + kPlotHeight * (1.0 - axis.share(value));
}

void add_grid(Svg& svg, const LineChart& chart, const Axis& x_axis, const Axis& y_axis) {
  // Half a step more, so that rounding loses no line.
  for (double y = y_axis.low; y < y_axis.high + 0.5 * y_axis.step; y += y_axis.step) {
    const double clean = y_axis.step * std::round(y / y_axis.step) + 0.0;  // of -0, 0
    svg.add(R"(<path d="M{} {:.1f}H{}" class="grid"/>)", kPlotLeft, y_of(y_axis, y),
            kChartWidth - kPlotRight);
    svg.add(R"(<text x="{}" y="{:.1f}" text-anchor="end">{:g}</text>)", kPlotLeft - 6.0,
            y_of(y_axis, y) + 4.0, clean);
  }
  for (double x = x_axis.low; x < x_axis.high + 0.5 * x_axis.step; x += x_axis.step) {
    svg.add(R"(<text x="{:.1f}" y="{}" text-anchor="middle">{:g}</text>)", x_of(x_axis, x),
            kPlotTop + kPlotHeight + 18.0, x_axis.step * std::round(x / x_axis.step));
  }
  svg.add(R"(<text x="{}" y="{}" text-anchor="end">{}</text>)", kChartWidth - kPlotRight, kPlotTop - 8.0,
          html_of(chart.y_unit));
  svg.add(R"(<text x="{}" y="{}" text-anchor="end">{}</text>)", kChartWidth - kPlotRight,
          kPlotTop + kPlotHeight + 34.0, html_of(chart.x_unit));
}

}  // namespace

std::string_view line_colour(std::size_t line) {
  constexpr std::array<std::string_view, 10> kLineColours{"#cc6677", "#332288", "#ddaa33", "#117733",
                                                          "#88ccee", "#882255", "#44aa99", "#999933",
                                                          "#aa4499", "#8a8781"};
  return kLineColours[line % kLineColours.size()];
}

std::string line_chart_svg(const LineChart& chart) {
  const Axis x_axis = axis_over(chart.lines, &LineChart::Line::x);
  const Axis y_axis = axis_over(chart.lines, &LineChart::Line::y);
  const auto named = static_cast<std::size_t>(
      std::ranges::count_if(chart.lines, [](const LineChart::Line& line) { return !line.name.empty(); }));
  constexpr std::size_t kColumns = 4;
  const std::size_t rows = (named + kColumns - 1) / kColumns;
  const double height = kKeyTop + kKeyRow * static_cast<double>(rows);
  Svg svg;
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" class="chart" viewBox="0 0 {} {}" role="img">)",
          kChartWidth, height);
  svg.add(R"(<text x="{}" y="{}" class="strip">{}</text>)", kPlotLeft, kPlotTop - 8.0, html_of(chart.title));
  add_grid(svg, chart, x_axis, y_axis);
  std::size_t in_key = 0;
  for (const LineChart::Line& line : chart.lines) {
    std::vector<double> xs;
    std::vector<double> ys;
    for (const double x : line.x) xs.push_back(x_of(x_axis, x));
    for (const double y : line.y) ys.push_back(y_of(y_axis, y));
    constexpr double kLongestGap = 30.0;
    svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.4" stroke-linejoin="round"/>)",
            line_path(xs, ys, kLongestGap), line.colour);
    if (line.name.empty()) continue;
    const double x = kPlotLeft + kKeyColumn * static_cast<double>(in_key % kColumns);
    const std::size_t row = in_key / kColumns;
    const double y = kKeyTop + kKeyRow * static_cast<double>(row);
    svg.add(R"(<path d="M{} {}h18" stroke="{}" stroke-width="3"/><text x="{}" y="{}">{}</text>)", x, y - 4.0,
            line.colour, x + 24.0, y, html_of(line.name));
    ++in_key;
  }
  svg.add("</svg>");
  return svg.take();
}

}  // namespace landfix::tools
