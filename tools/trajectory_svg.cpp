#include "tools/trajectory_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "platform/evaluation.hpp"
#include "tools/map_raster.hpp"
#include "tools/svg.hpp"

namespace landfix::tools {
namespace {

using platform::StampedPose;

// Pixels.
constexpr double kPageWidth = 1100.0;
constexpr double kMapHeight = 760.0;
constexpr double kMargin = 30.0;
constexpr double kTitleHeight = 74.0;
constexpr double kChartHeight = 110.0;
constexpr double kChartGap = 46.0;

constexpr std::array<std::string_view, kShades> kShadeColours{"#eceae5", "#d3d0c9", "#aaa69d", "#6f6c66"};
/// From exact to wrong; dark to light would be lost on the map.
constexpr std::array<std::string_view, 7> kErrorColours{"#1a7f5a", "#4fae4e", "#a3c83c", "#f2c531",
                                                        "#f39a2b", "#e65f2b", "#c2242c"};
constexpr std::string_view kPlainColour = "#c2242c";
constexpr std::string_view kTruthColour = "#8fbce6";

/// Positions of the trajectory, with what is known of their errors.
struct Track {
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<double> distances_m;              ///< driven until there
  std::vector<std::optional<double>> errors_m;  ///< where there is truth for the time
  double largest_error_m = 0.0;

  [[nodiscard]] bool has_errors() const {
    return std::ranges::any_of(errors_m, [](const auto& error) { return error.has_value(); });
  }
  [[nodiscard]] double length_m() const { return distances_m.empty() ? 0.0 : distances_m.back(); }
};

Track make_track(std::span<const StampedPose> trajectory, std::span<const StampedPose> truth) {
  Track track;
  for (const StampedPose& stamped : trajectory) {
    const Eigen::Vector3d position_m = stamped.pose.translation();
    const double step_m = track.positions_m.empty() ? 0.0 : (position_m - track.positions_m.back()).norm();
    track.distances_m.push_back(track.length_m() + step_m);
    track.positions_m.push_back(position_m);
    const std::optional<ndt::Pose> true_pose = platform::interpolate(truth, stamped.stamp_utc_ns);
    std::optional<double>& error_m = track.errors_m.emplace_back();
    if (!true_pose) continue;
    error_m = (true_pose->translation() - position_m).norm();
    track.largest_error_m = std::max(track.largest_error_m, *error_m);
  }
  return track;
}

/// Errors in centimetres up to which the colours go.
double colour_limit_cm(const Track& track) {
  return nice_above(std::max(100.0 * track.largest_error_m, 1.0));
}

std::string_view colour_of(const std::optional<double>& error_m, double limit_cm) {
  if (!error_m) return kPlainColour;
  const double share = 100.0 * *error_m / limit_cm * static_cast<double>(kErrorColours.size());
  return kErrorColours[std::min(static_cast<std::size_t>(share), kErrorColours.size() - 1)];
}

/// What part of the map is shown, and where its points come to lie.
class View {
 public:
  View(std::span<const Eigen::Vector3d> positions_m, std::span<const StampedPose> truth) {
    constexpr double kAround_m = 35.0;
    for (const Eigen::Vector3d& position_m : positions_m)
      area_m_.extend(Eigen::Vector2d(position_m.head<2>()));
    for (const StampedPose& stamped : truth) {
      area_m_.extend(Eigen::Vector2d(stamped.pose.translation().head<2>()));
    }
    if (area_m_.isEmpty()) area_m_.extend(Eigen::Vector2d(0.0, 0.0));
    area_m_ = Eigen::AlignedBox2d(area_m_.min().array() - kAround_m, area_m_.max().array() + kAround_m);
    pixels_per_m_ =
        std::min((kPageWidth - 2.0 * kMargin) / area_m_.sizes().x(), kMapHeight / area_m_.sizes().y());
    left_ = 0.5 * (kPageWidth - pixels_per_m_ * area_m_.sizes().x());
  }

  [[nodiscard]] const Eigen::AlignedBox2d& area_m() const { return area_m_; }
  [[nodiscard]] double pixels_per_m() const { return pixels_per_m_; }
  [[nodiscard]] double left() const { return left_; }
  [[nodiscard]] double bottom() const { return kTitleHeight + pixels_per_m_ * area_m_.sizes().y(); }
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& position_m) const {
    return {left_ + pixels_per_m_ * (position_m.x() - area_m_.min().x()),
            kTitleHeight + pixels_per_m_ * (area_m_.max().y() - position_m.y())};
  }

 private:
  Eigen::AlignedBox2d area_m_;
  double pixels_per_m_ = 1.0;
  double left_ = 0.0;
};

void add_map(Svg& svg, std::span<const Eigen::Vector3f> points_m, const View& view) {
  const MapRaster raster = rasterise(points_m, view.area_m());
  svg.add(
      R"svg(<g id="map" transform="translate({:.2f} {:.2f}) scale({:.5f})" shape-rendering="crispEdges">)svg",
      view.left(), kTitleHeight, raster.cell_m * view.pixels_per_m());
  for (std::size_t shade = 0; shade < kShades; ++shade) {
    if (raster.paths[shade].empty()) continue;
    svg.add(R"(<path fill="{}" d="{}"/>)", kShadeColours[shade], raster.paths[shade]);
  }
  svg.add("</g>");
}

void add_truth(Svg& svg, std::span<const StampedPose> truth, const View& view) {
  constexpr double kStep_pixels = 1.5;  // a finer line would only be a larger file
  std::string points;
  Eigen::Vector2d last(-1e9, -1e9);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d pixel = view.pixel(truth[i].pose.translation());
    if ((pixel - last).norm() < kStep_pixels && i + 1 < truth.size()) continue;
    points += fmt::format("{:.1f},{:.1f} ", pixel.x(), pixel.y());
    last = pixel;
  }
  svg.add(
      R"(<polyline id="truth" points="{}" fill="none" stroke="{}" stroke-width="8" stroke-opacity="0.75" )"
      R"(stroke-linejoin="round" stroke-linecap="round"/>)",
      points, kTruthColour);
}

/// One line for each stretch of a colour.
void add_trajectory(Svg& svg, const Track& track, const View& view) {
  const double limit_cm = colour_limit_cm(track);
  svg.add(
      R"(<g id="trajectory" fill="none" stroke-width="3" stroke-linejoin="round" stroke-linecap="round">)");
  for (std::size_t i = 0; i + 1 < track.positions_m.size();) {
    const std::string_view colour = colour_of(track.errors_m[i], limit_cm);
    std::string points;
    std::size_t end = i;
    do {
      const Eigen::Vector2d pixel = view.pixel(track.positions_m[end]);
      points += fmt::format("{:.1f},{:.1f} ", pixel.x(), pixel.y());
    } while (end++ == i ||
             (end < track.positions_m.size() && colour_of(track.errors_m[end - 1], limit_cm) == colour));
    svg.add(R"(<polyline stroke="{}" points="{}"/>)", colour, points);
    i = end - 1;
  }
  svg.add("</g>");
}

void add_mark(Svg& svg, const Eigen::Vector2d& at, std::string_view colour, std::string_view name) {
  svg.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="6.5" fill="{}" stroke="#fff" stroke-width="2"/>)", at.x(),
          at.y(), colour);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}" class="mark">{}</text>)", at.x() + 11.0, at.y() + 5.0, name);
}

/// The length of a round number of metres, and where x and y point.
void add_scale(Svg& svg, const View& view) {
  const double length_m = nice_below(160.0 / view.pixels_per_m());
  const double x = kMargin + 12.0;
  const double y = view.bottom() - 16.0;
  svg.add(R"(<path d="M{0:.1f} {1:.1f}v8h{2:.1f}v-8" fill="none" stroke="#222" stroke-width="2"/>)", x,
          y - 8.0, length_m * view.pixels_per_m());
  svg.add(R"(<text x="{:.1f}" y="{:.1f}">{:g} m</text>)", x + 6.0, y - 6.0, length_m);
  svg.add(
      R"(<path d="M{0:.1f} {1:.1f}m0 -34v34h34m-6 -4l6 4l-6 4m-32 -32l4 -6l4 6" fill="none" stroke="#222" )"
      R"(stroke-width="1.5"/>)",
      x + 4.0, y - 40.0);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}">x</text><text x="{:.1f}" y="{:.1f}">y</text>)", x + 43.0, y - 36.0,
          x + 12.0, y - 66.0);
}

void add_legend(Svg& svg, const Track& track, const View& view) {
  constexpr double kSwatch = 26.0;
  const double limit_cm = colour_limit_cm(track);
  const double y = view.bottom() - 24.0;
  double x = kPageWidth - kMargin - kSwatch * static_cast<double>(kErrorColours.size()) - 46.0;
  svg.add(
      R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="66" rx="5" fill="#fff" fill-opacity="0.85"/>)",
      x - 12.0, y - 48.0, kSwatch * static_cast<double>(kErrorColours.size()) + 60.0);
  svg.add(R"(<path d="M{:.1f} {:.1f}h40" stroke="{}" stroke-width="8" stroke-linecap="round"/>)", x + 4.0,
          y - 32.0, kTruthColour);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}">truth</text>)", x + 54.0, y - 28.0);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}">position error</text>)", x + 98.0, y - 28.0);
  for (const auto& colour : kErrorColours) {
    svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="10" fill="{}"/>)", x, y - 14.0, kSwatch,
            colour);
    x += kSwatch;
  }
  const double left = x - kSwatch * static_cast<double>(kErrorColours.size());
  svg.add(R"(<text x="{:.1f}" y="{:.1f}">0</text>)", left, y + 11.0);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:g}</text>)", 0.5 * (left + x), y + 11.0,
          0.5 * limit_cm);
  svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:g} cm</text>)", x, y + 11.0, limit_cm);
}

/// The error over the distance driven: what a centimetre on a map of hundreds of metres cannot show.
void add_chart(Svg& svg, const Track& track, const View& view) {
  const double limit_cm = colour_limit_cm(track);
  const double top = view.bottom() + kChartGap;
  const double left = kMargin + 40.0;
  const double width = kPageWidth - kMargin - 12.0 - left;
  const double length_m = std::max(track.length_m(), 1.0);
  const double step_m = nice_below(length_m / 4.0);
  svg.add(
      R"(<text x="{:.1f}" y="{:.1f}" class="mark">position error [cm] over the distance driven [m]</text>)",
      left, top - 10.0);
  for (const double share : {0.0, 0.5, 1.0}) {
    const double y = top + kChartHeight * (1.0 - share);
    svg.add(R"(<path d="M{:.1f} {:.1f}h{:.1f}" stroke="#ccc"/>)", left, y, width);
    svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{:g}</text>)", left - 7.0, y + 4.0,
            share * limit_cm);
  }
  for (double at_m = 0.0; at_m <= length_m; at_m += step_m) {
    svg.add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:g}</text>)", left + width * at_m / length_m,
            top + kChartHeight + 17.0, at_m);
  }
  std::string points;
  for (std::size_t i = 0; i < track.errors_m.size(); ++i) {
    if (!track.errors_m[i]) continue;
    points += fmt::format("{:.1f},{:.1f} ", left + width * track.distances_m[i] / length_m,
                          top + kChartHeight * (1.0 - 100.0 * *track.errors_m[i] / limit_cm));
  }
  svg.add(R"(<polyline id="error" points="{}" fill="none" stroke="#1a7f5a" stroke-width="1.5"/>)", points);
}

void add_title(Svg& svg, const Track& track, std::span<const StampedPose> trajectory,
               std::span<const StampedPose> truth) {
  svg.add(R"(<text x="{}" y="34" class="title">{:.0f} m, {} {}</text>)", kMargin, track.length_m(),
          trajectory.size(), trajectory.size() == 1 ? "pose" : "poses");
  if (!track.has_errors()) return;
  const platform::Evaluation errors = platform::evaluate(truth, trajectory);
  svg.add(
      R"(<text x="{}" y="58" class="mark">RMSE of the position {:.1f} cm (largest error {:.1f} cm), of the )"
      R"(heading {:.3f}°, of roll {:.3f}°, of pitch {:.3f}°</text>)",
      kMargin, 100.0 * errors.ate_m.rmse, 100.0 * errors.ate_m.max, errors.heading_deg.rmse,
      errors.roll_deg.rmse, errors.pitch_deg.rmse);
}

}  // namespace

std::string trajectory_svg(std::span<const Eigen::Vector3f> map_points_m,
                           std::span<const StampedPose> trajectory, std::span<const StampedPose> truth) {
  const Track track = make_track(trajectory, truth);
  const View view(track.positions_m, truth);
  const double height =
      view.bottom() + (track.has_errors() ? kChartGap + kChartHeight + 20.0 : 0.0) + kMargin;
  Svg svg;
  svg.add(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}" )"
      R"(font-family="sans-serif" font-size="12" fill="#222">)",
      kPageWidth, height);
  svg.add("<style>.title{{font-size:22px;font-weight:bold}} .mark{{font-size:14px}}</style>");
  svg.add(R"(<rect width="100%" height="100%" fill="#fff"/>)");
  add_title(svg, track, trajectory, truth);
  add_map(svg, map_points_m, view);
  if (!truth.empty()) add_truth(svg, truth, view);
  add_trajectory(svg, track, view);
  if (!track.positions_m.empty()) {
    add_mark(svg, view.pixel(track.positions_m.back()), "#c2242c", "end");
    add_mark(svg, view.pixel(track.positions_m.front()), "#1a7f5a", "start");
  }
  add_scale(svg, view);
  if (track.has_errors()) {
    add_legend(svg, track, view);
    add_chart(svg, track, view);
  }
  svg.add("</svg>");
  return svg.take();
}

}  // namespace landfix::tools
