#include "tools/quality_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "tools/class_grid.hpp"
#include "tools/svg.hpp"

namespace landfix::tools {
namespace {

// Pixels.
constexpr double kPictureWidth = 1100.0;
constexpr double kMostPanelHeight = 760.0;
constexpr double kPictureMargin = 24.0;
constexpr double kPanelTitleHeight = 56.0;

constexpr double kFinestSquare_m = 0.25;
constexpr double kMostSquares = 1e6;
constexpr std::size_t kMostPathBytes = 2'000'000;

/// From crisp to blurred: dark to light, told apart by those who see no red or green too (S. van der Walt and
/// N. Smith's "viridis", ten of its steps).
constexpr std::array<std::string_view, 10> kColours{"#440154", "#482878", "#3e4989", "#31688e", "#26828e",
                                                    "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"};

struct Panel {
  std::string_view title;
  std::string_view unit;
  float JudgedPoint::*value;
  double scale;
};
constexpr std::array<Panel, 2> kPanels{{{"Entropy", "", &JudgedPoint::entropy, 1.0},
                                        {"Plane variance", " cm", &JudgedPoint::plane_variance_m, 100.0}}};

/// What the colours mean: outside of this range are few.
struct ColourScale {
  double low = 0.0;
  double high = 1.0;

  [[nodiscard]] std::uint8_t class_of(double value) const {
    const double share = (value - low) / (high - low) * static_cast<double>(kColours.size());
    return static_cast<std::uint8_t>(std::clamp(share, 0.0, static_cast<double>(kColours.size() - 1)));
  }
};

[[nodiscard]] ColourScale scale_of(std::span<const JudgedPoint> points, const Panel& panel) {
  constexpr double kLowShare = 0.02;
  constexpr double kHighShare = 0.98;
  std::vector<float> values;
  for (const JudgedPoint& point : points)
    if (std::isfinite(point.*panel.value)) values.push_back(point.*panel.value);
  if (values.empty()) return {};
  const auto at = [&values](double share) {
    const auto nth =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return static_cast<double>(*nth);
  };
  const double low = at(kLowShare);
  return {.low = low, .high = std::max(at(kHighShare), low + 1e-9)};
}

[[nodiscard]] ClassGrid classify(std::span<const JudgedPoint> points, const Eigen::AlignedBox2d& area_m,
                                 double cell_m, const Panel& panel, const ColourScale& scale) {
  ClassGrid grid{.columns = static_cast<std::size_t>(area_m.sizes().x() / cell_m) + 1,
                 .rows = static_cast<std::size_t>(area_m.sizes().y() / cell_m) + 1,
                 .classes = {}};
  std::vector<double> sums(grid.columns * grid.rows, 0.0);
  std::vector<std::uint32_t> counts(sums.size(), 0);
  for (const JudgedPoint& point : points) {
    if (!std::isfinite(point.*panel.value)) continue;
    const auto column = static_cast<std::size_t>((static_cast<double>(point.x) - area_m.min().x()) / cell_m);
    const auto row = static_cast<std::size_t>((area_m.max().y() - static_cast<double>(point.y)) / cell_m);
    sums[row * grid.columns + column] += static_cast<double>(point.*panel.value);
    ++counts[row * grid.columns + column];
  }
  grid.classes.assign(sums.size(), ClassGrid::kEmpty);
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (counts[i] != 0) grid.classes[i] = scale.class_of(sums[i] / counts[i]);
  return grid;
}

struct Raster {
  double cell_m = kFinestSquare_m;
  std::vector<std::string> paths;
};

[[nodiscard]] Raster raster_of(std::span<const JudgedPoint> points, const Eigen::AlignedBox2d& area_m,
                               const Panel& panel, const ColourScale& scale) {
  Raster raster;
  for (;; raster.cell_m *= 2.0) {
    if (area_m.sizes().x() * area_m.sizes().y() > kMostSquares * raster.cell_m * raster.cell_m) continue;
    raster.paths = class_paths(classify(points, area_m, raster.cell_m, panel, scale), kColours.size());
    std::size_t bytes = 0;
    for (const std::string& path : raster.paths) bytes += path.size();
    if (bytes <= kMostPathBytes) return raster;
  }
}

void draw_key(Svg& svg, const Panel& panel, const ColourScale& scale) {
  constexpr double kSwatchWidth = 24.0;
  const double left = kPictureWidth - kPictureMargin - kSwatchWidth * static_cast<double>(kColours.size());
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    svg.add(R"(<rect x="{}" y="14" width="{}" height="12" fill="{}"/>)",
            left + kSwatchWidth * static_cast<double>(i), kSwatchWidth, kColours[i]);
  }
  svg.add(R"(<text x="{}" y="42">{:.2f}</text>)", left, panel.scale * scale.low);
  svg.add(R"(<text x="{}" y="42" text-anchor="end">{:.2f}{}</text>)", kPictureWidth - kPictureMargin,
          panel.scale * scale.high, panel.unit);
}

}  // namespace

std::string quality_svg(std::span<const JudgedPoint> points) {
  Eigen::AlignedBox2d area_m;
  for (const JudgedPoint& point : points)
    if (std::isfinite(point.entropy)) area_m.extend(Eigen::Vector2f(point.x, point.y).cast<double>());
  if (area_m.isEmpty()) area_m = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones());
  const Eigen::Vector2d sizes_m = area_m.sizes().cwiseMax(1.0);
  const double pixels_1pm =
      std::min((kPictureWidth - 2.0 * kPictureMargin) / sizes_m.x(), kMostPanelHeight / sizes_m.y());
  const double panel_height = kPanelTitleHeight + pixels_1pm * sizes_m.y() + kPictureMargin;
  Svg svg;
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {:.0f}" font-family="sans-serif" )"
          R"(font-size="14" fill="#22211e">)",
          kPictureWidth, panel_height * static_cast<double>(kPanels.size()));
  svg.add(R"(<rect width="100%" height="100%" fill="#ffffff"/>)");
  for (std::size_t i = 0; i < kPanels.size(); ++i) {
    const ColourScale scale = scale_of(points, kPanels[i]);
    const Raster raster = raster_of(points, area_m, kPanels[i], scale);
    svg.add(R"svg(<g transform="translate(0 {:.0f})">)svg", panel_height * static_cast<double>(i));
    svg.add(R"(<text x="{}" y="28" font-size="17">{}</text>)", kPictureMargin, kPanels[i].title);
    svg.add(R"(<text x="{}" y="46" fill="#6d6a63">mean of each cell of {:g} m; {:.0f} m across</text>)",
            kPictureMargin, raster.cell_m, sizes_m.x());
    draw_key(svg, kPanels[i], scale);
    svg.add(R"svg(<g transform="translate({:.2f} {}) scale({:.5f})">)svg",
            0.5 * (kPictureWidth - pixels_1pm * sizes_m.x()), kPanelTitleHeight, pixels_1pm * raster.cell_m);
    for (std::size_t colour = 0; colour < kColours.size(); ++colour)
      svg.add(R"(<path fill="{}" d="{}"/>)", kColours[colour], raster.paths[colour]);
    svg.add("</g></g>");
  }
  svg.add("</svg>");
  return svg.take();
}

}  // namespace landfix::tools
