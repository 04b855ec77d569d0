#include "tools/study/scan_pictures.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "drivers/sweep.hpp"
#include "ndt/motion.hpp"
#include "ndt/scan_filter.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/atomic_file.hpp"
#include "tools/class_grid.hpp"
#include "tools/input_files.hpp"
#include "tools/map_raster.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/study/localization.hpp"
#include "tools/svg.hpp"

namespace landfix::tools::study {
namespace {

// Pixels.
constexpr double kScanSide = 700.0;
constexpr double kPanelSide = 350.0;
constexpr double kCaption = 24.0;

constexpr std::array<std::string_view, kShades> kMapColours{"#efede8", "#dddad2", "#c4c0b7", "#a5a198"};
/// From dark to bright returns.
constexpr std::array<std::string_view, 8> kIntensityColours{"#30123b", "#4662d7", "#36aaf9", "#1ae4b6",
                                                            "#72fe5e", "#c8ef34", "#faba39", "#f66b19"};

/// Frame `vehicle` at the sweep's end.
struct UndistortedSweep {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<float> intensities;
  ndt::Pose pose = ndt::Pose::Identity();  ///< map <- vehicle
};

[[nodiscard]] UndistortedSweep undistorted(const drivers::Sweep& sweep, const ndt::StampedPose& before,
                                           const ndt::StampedPose& at) {
  ndt::Deskew deskew;
  deskew.begin(sweep.start_utc_ns(), ndt::velocity_between(before, at), simulator::kSensorMounting.pose());
  const Eigen::Isometry3f to_end = deskew.from_start(sweep.end_utc_ns()).cast<float>();
  UndistortedSweep result{.points_m = {}, .intensities = {}, .pose = at.pose};
  for (const drivers::Point& point : sweep.points()) {
    result.points_m.push_back(to_end * deskew.to_start(point, 0.0F));
    result.intensities.push_back(point.intensity);
  }
  return result;
}

[[nodiscard]] std::vector<Eigen::Vector3f> means_of(const std::filesystem::path& map) {
  const ndt::MapImage image = load_map_file(map);
  std::vector<Eigen::Vector3f> means_m;
  ndt::visit_voxels(ndt::VoxelMap(image.bytes()),
                    [&means_m](const ndt::Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
                      means_m.emplace_back(mean_m.cast<float>());
                    });
  return means_m;
}

void add_paths(Svg& svg, std::span<const std::string> paths, std::span<const std::string_view> colours,
               double scale) {
  svg.add(R"svg(<g transform="translate(0 {}) scale({:.4f})" shape-rendering="crispEdges">)svg", kCaption,
          scale);
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!paths[i].empty()) svg.add(R"(<path fill="{}" d="{}"/>)", colours[i], paths[i]);
  svg.add("</g>");
}

void begin_picture(Svg& svg, double width, double height) {
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" font-family="sans-serif" )"
          R"(font-size="13" fill="#22211e"><rect width="100%" height="100%" fill="#ffffff"/>)",
          width, height);
}

[[nodiscard]] std::string scan_svg(const UndistortedSweep& sweep, std::span<const Eigen::Vector3f> map_m) {
  constexpr double kReach_m = 50.0;
  constexpr double kCell_m = 0.25;
  constexpr float kClassWidth = 256.0F / static_cast<float>(kIntensityColours.size());
  const Eigen::Vector2d middle_m = sweep.pose.translation().head<2>();
  const Eigen::AlignedBox2d area_m(middle_m.array() - kReach_m, middle_m.array() + kReach_m);
  constexpr auto kCells = static_cast<std::size_t>(2.0 * kReach_m / kCell_m);
  ClassGrid grid{.columns = kCells, .rows = kCells, .classes = {}};
  grid.classes.assign(kCells * kCells, ClassGrid::kEmpty);
  for (std::size_t i = 0; i < sweep.points_m.size(); ++i) {
    const Eigen::Vector2d at_m = (sweep.pose * sweep.points_m[i].cast<double>()).head<2>();
    if (!area_m.contains(at_m)) continue;
    const auto column =
        std::min(static_cast<std::size_t>((at_m.x() - area_m.min().x()) / kCell_m), kCells - 1);
    const auto row = std::min(static_cast<std::size_t>((area_m.max().y() - at_m.y()) / kCell_m), kCells - 1);
    constexpr auto kBrightest = static_cast<float>(kIntensityColours.size() - 1);
    grid.classes[row * kCells + column] =
        static_cast<std::uint8_t>(std::min(sweep.intensities[i] / kClassWidth, kBrightest));
  }
  const MapRaster map = rasterise(map_m, area_m);
  Svg svg;
  begin_picture(svg, kScanSide, kScanSide + kCaption);
  svg.add(R"(<text x="6" y="17">one sweep over the surveyed map, {:g} m across; by intensity</text>)",
          2.0 * kReach_m);
  for (std::size_t i = 0; i < kIntensityColours.size(); ++i)
    svg.add(R"(<rect x="{}" y="6" width="20" height="12" fill="{}"/>)",
            kScanSide - 20.0 * static_cast<double>(kIntensityColours.size() - i) - 6.0, kIntensityColours[i]);
  add_paths(svg, map.paths, kMapColours, map.cell_m * kScanSide / (2.0 * kReach_m));
  add_paths(svg, class_paths(grid, kIntensityColours.size()), kIntensityColours,
            kCell_m * kScanSide / (2.0 * kReach_m));
  svg.add("</svg>");
  return svg.take();
}

/// A dot a point that is left.
[[nodiscard]] std::string filtered_svg(const UndistortedSweep& sweep) {
  constexpr std::array kReaches_m{200.0, 100.0, 50.0, 20.0};
  const ndt::FilterSettings filter;
  Svg svg;
  begin_picture(svg, 2.0 * kPanelSide, 2.0 * (kPanelSide + kCaption));
  for (std::size_t i = 0; i < kReaches_m.size(); ++i) {
    const double reach_m = kReaches_m[i];
    const std::size_t row = i / 2;
    ndt::ScanFilter thin(filter, sweep.points_m.size());
    for (const Eigen::Vector3f& point_m : sweep.points_m)
      if (static_cast<double>(point_m.norm()) <= reach_m) thin.add(point_m, 0);
    const auto left_m = thin.finish();
    const double scale = kPanelSide / (2.0 * reach_m);
    svg.add(R"svg(<g transform="translate({} {})"><text x="6" y="17">{:g} m: {} points</text>)svg",
            kPanelSide * static_cast<double>(i % 2), (kPanelSide + kCaption) * static_cast<double>(row),
            reach_m, left_m.size());
    std::string dots;
    for (const Eigen::Vector3f& point_m : left_m) {
      dots += fmt::format("M{:.0f} {:.0f}h0", 0.5 * kPanelSide + scale * static_cast<double>(point_m.x()),
                          kCaption + 0.5 * kPanelSide - scale * static_cast<double>(point_m.y()));
    }
    svg.add(R"(<path d="{}" fill="none" stroke="#2b6cb0" stroke-width="1.8" stroke-linecap="round"/></g>)",
            dots);
  }
  svg.add("</svg>");
  return svg.take();
}

}  // namespace

bool draw_sweep(const std::filesystem::path& drive, const CaptureInput& input,
                std::span<const platform::StampedPose> trajectory, std::int64_t stamp_utc_ns) {
  const auto map_m = means_of(map_of(drive, 1.0));
  DecodedCapture capture(input);
  bool is_past = false;
  bool is_drawn = false;
  (void)capture.read([&](const drivers::Sweep& sweep) {
    if (is_past || sweep.end_utc_ns() < stamp_utc_ns) return;
    is_past = true;
    const auto before = platform::interpolate(trajectory, sweep.start_utc_ns());
    const auto at = platform::interpolate(trajectory, sweep.end_utc_ns());
    if (!before || !at) return;
    const UndistortedSweep shown =
        undistorted(sweep, {sweep.start_utc_ns(), *before}, {sweep.end_utc_ns(), *at});
    platform::write_file(drive / "scan.svg", scan_svg(shown, map_m));
    platform::write_file(drive / "filtered.svg", filtered_svg(shown));
    is_drawn = true;
  });
  return is_drawn;
}

}  // namespace landfix::tools::study
