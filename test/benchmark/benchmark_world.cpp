#include "benchmark/benchmark_world.hpp"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "ndt/pcd.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_grid.hpp"
#include "platform/atomic_file.hpp"
#include "platform/trajectory.hpp"
#include "tools/input_files.hpp"

namespace landfix::test {
namespace {

[[nodiscard]] const BenchmarkWorld& yard() {
  constexpr std::size_t kScan = 29'000;  // a VLP-16's at 10 Hz
  static const BenchmarkWorld world = [] {
    // The scan has other points of the same surfaces than the map.
    std::vector<Eigen::Vector3d> surveyed_m = ndt::test::random_yard(1, 200'000 + kScan);
    const auto scanned = surveyed_m.end() - kScan;
    const std::vector<Eigen::Vector3d> scan_m(scanned, surveyed_m.end());
    surveyed_m.erase(scanned, surveyed_m.end());
    return BenchmarkWorld("yard", std::move(surveyed_m), ndt::test::seen_from(scan_m, ndt::Pose::Identity()),
                          ndt::Pose::Identity());
  }();
  return world;
}

/// The middle of PandaSet's drive 002.
[[nodiscard]] const BenchmarkWorld& drive(const std::filesystem::path& folder) {
  static const BenchmarkWorld world = [&folder] {
    constexpr std::size_t kMiddle = 14;
    const std::string map = folder / "map.pcd";
    std::vector<Eigen::Vector3d> surveyed_m;
    ndt::visit_pcd_positions(platform::read_file(map), map,
                             [&](const Eigen::Vector3d& point_m) { surveyed_m.push_back(point_m); });
    return BenchmarkWorld("drive", std::move(surveyed_m),
                          tools::load_scan(tools::list_clouds(folder / "scans").at(kMiddle), {}),
                          platform::read_tum(folder / "truth.tum").at(kMiddle).pose);
  }();
  return world;
}

}  // namespace

BenchmarkWorld::BenchmarkWorld(std::string name_, std::vector<Eigen::Vector3d> surveyed,
                               std::vector<Eigen::Vector3f> scan, const ndt::Pose& truth_)
    : name(std::move(name_)),
      surveyed_m(std::move(surveyed)),
      scan_m(std::move(scan)),
      truth(truth_),
      guess(truth_ * ndt::make_pose({0.25, -0.15, 0.08}, {.yaw_rad = ndt::kRadians_per_deg})),
      image(ndt::test::build_map(surveyed_m, kResolution_m)),
      map(image.bytes()) {}

std::vector<Eigen::Vector3f> BenchmarkWorld::thinned(double leaf_m) const {
  ndt::VoxelGrid grid(leaf_m, scan_m.size());
  for (const Eigen::Vector3f& point_m : scan_m) grid.add(point_m);
  const auto left = grid.finish();
  return {left.begin(), left.end()};
}

const std::vector<const BenchmarkWorld*>& benchmark_worlds() {
  static const std::vector<const BenchmarkWorld*> worlds = [] {
    std::vector<const BenchmarkWorld*> found{&yard()};
    const char* const data = std::getenv("LANDFIX_TEST_DATA");
    const std::filesystem::path folder =
        std::filesystem::path(data == nullptr ? "" : data) / "drive-pandaset-002";
    if (std::filesystem::exists(folder)) found.push_back(&drive(folder));
    return found;
  }();
  return worlds;
}

}  // namespace landfix::test
