#include "tools/latency_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/svg.hpp"

namespace landfix::tools {
namespace {

using platform::LatencyDistribution;

// Pixels.
constexpr double kWidth = 720.0;
constexpr double kLeft = 112.0;
constexpr double kRight = 26.0;
constexpr double kTop = 26.0;
constexpr double kRowHeight = 46.0;
constexpr double kRowGap = 14.0;
constexpr double kAxisHeight = 26.0;

constexpr double kLeast_ms = 1e-5;  ///< what is shorter is drawn there
constexpr double kBinsPerDecade = 24.0;

[[nodiscard]] double decade_of(double value_ms) { return std::log10(std::max(value_ms, kLeast_ms)); }

/// Whole decades.
struct LogAxis {
  double low = 0.0;
  double high = 1.0;

  [[nodiscard]] double x(double value_ms) const {
    return kLeft + (kWidth - kLeft - kRight) * (decade_of(value_ms) - low) / (high - low);
  }
};

[[nodiscard]] LogAxis axis_of(std::span<const LatencyDistribution> stages) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const LatencyDistribution& stage : stages) {
    if (stage.count() == 0) continue;
    low = std::min(low, decade_of(stage.percentile_ms(1.0)));
    high = std::max(high, decade_of(stage.max_ms));
  }
  low = std::floor(low);
  return {low, std::max(std::ceil(high), low + 1.0)};
}

[[nodiscard]] std::string decade_name(double decade) {
  if (decade < -3.0) return fmt::format("{:g} ns", std::pow(10.0, decade + 6.0));
  if (decade < 0.0) return fmt::format("{:g} µs", std::pow(10.0, decade + 3.0));
  return fmt::format("{:g} ms", std::pow(10.0, decade));
}

/// Values by bins of equal width on the axis.
[[nodiscard]] std::vector<double> bins_of(const LatencyDistribution& stage, const LogAxis& axis) {
  const auto bins = static_cast<std::size_t>(kBinsPerDecade * (axis.high - axis.low));
  std::vector<double> values(bins, 0.0);
  std::uint64_t before = 0;
  for (const auto& [value_ms, count] : stage.steps) {
    const double bin =
        std::clamp((decade_of(value_ms) - axis.low) * kBinsPerDecade, 0.0, static_cast<double>(bins - 1));
    values[static_cast<std::size_t>(bin)] += static_cast<double>(count - before);
    before = count;
  }
  return values;
}

void add_mark(Svg& svg, double x, double top, std::string_view name, std::string_view css_class) {
  svg.add(R"(<path d="M{:.1f} {:.1f}v{}" class="{}"><title>{}</title></path>)", x, top, kRowHeight, css_class,
          name);
}

void add_row(Svg& svg, const LatencyDistribution& stage, const LogAxis& axis, double top) {
  const std::vector<double> bins = bins_of(stage, axis);
  const double most = *std::max_element(bins.begin(), bins.end());
  const double width = (kWidth - kLeft - kRight) / static_cast<double>(bins.size());
  const double bottom = top + kRowHeight;
  svg.add(R"(<text x="{}" y="{:.1f}" text-anchor="end" class="strip">{}</text>)", kLeft - 12.0, bottom - 6.0,
          stage.stage);
  svg.add(R"(<path d="M{} {:.1f}H{}" class="grid"/>)", kLeft, bottom, kWidth - kRight);
  std::string path;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i] == 0.0) continue;
    // The root shows a single late sweep among thousands.
    const double height = std::max(1.5, kRowHeight * std::sqrt(bins[i] / most));
    path += fmt::format("M{:.1f} {:.1f}v{:.1f}h{:.1f}v{:.1f}z", kLeft + width * static_cast<double>(i),
                        bottom, -height, width - 0.6, height);
  }
  svg.add(R"(<path d="{}" class="bars"/>)", path);
  add_mark(svg, axis.x(stage.percentile_ms(50.0)), top,
           fmt::format("p50 {:.4f} ms", stage.percentile_ms(50.0)), "p50");
  add_mark(svg, axis.x(stage.percentile_ms(99.0)), top,
           fmt::format("p99 {:.4f} ms", stage.percentile_ms(99.0)), "p99");
  add_mark(svg, axis.x(stage.max_ms), top, fmt::format("max {:.4f} ms", stage.max_ms), "max");
}

void add_axis(Svg& svg, const LogAxis& axis, double bottom) {
  for (double decade = axis.low; decade <= axis.high; decade += 1.0) {
    const double x = axis.x(std::pow(10.0, decade));
    svg.add(R"(<path d="M{:.1f} {}V{:.1f}" class="grid"/>)", x, kTop, bottom);
    svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", x, bottom + 18.0,
            decade_name(decade));
  }
}

void add_legend(Svg& svg) {
  double x = kLeft;
  for (const std::string_view name : {"p50", "p99", "max"}) {
    svg.add(R"(<path d="M{:.1f} 6v12" class="{}"/><text x="{:.1f}" y="16">{}</text>)", x, name, x + 7.0,
            name);
    x += 56.0;
  }
}

}  // namespace

std::string latency_chart_svg(std::span<const LatencyDistribution> stages) {
  const auto rows =
      std::ranges::count_if(stages, [](const LatencyDistribution& stage) { return stage.count() != 0; });
  if (rows == 0) return {};
  const LogAxis axis = axis_of(stages);
  const double bottom = kTop + static_cast<double>(rows) * (kRowHeight + kRowGap);
  Svg svg;
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" class="chart" viewBox="0 0 {} {}" role="img">)", kWidth,
          bottom + kAxisHeight);
  add_axis(svg, axis, bottom);
  add_legend(svg);
  double top = kTop + kRowGap;
  for (const LatencyDistribution& stage : stages) {
    if (stage.count() == 0) continue;
    add_row(svg, stage, axis, top);
    top += kRowHeight + kRowGap;
  }
  svg.add("</svg>");
  return svg.take();
}

}  // namespace landfix::tools
