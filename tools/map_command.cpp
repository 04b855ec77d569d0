// landfix map: a voxel map from surveyed point clouds.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ndt/lattice.hpp"
#include "ndt/voxel_map.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "platform/atomic_file.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct MapArguments {
  std::vector<std::string> clouds;
  std::string output;
  double resolution_m = 1.0;
  std::vector<double> origin_m{0.0, 0.0, 0.0};
  std::size_t capacity = kMapCapacity;
  bool json = false;
};

/// Throws UsageError where the map would take the place of one of the clouds.
void spare_clouds(const std::vector<std::filesystem::path>& clouds, const std::string& output) {
  if (!std::filesystem::exists(output)) return;
  for (const std::filesystem::path& cloud : clouds) {
    if (std::filesystem::equivalent(cloud, output)) {
      throw UsageError(fmt::format("--output {} is one of the clouds, which would be lost", output));
    }
  }
}

/// Throws UsageError where the lattice does not reach.
void check_origin(const Eigen::Vector3d& origin_m, double resolution_m) {
  if (ndt::has_cell(origin_m / resolution_m)) return;
  throw UsageError(fmt::format("--origin: a map with cells of {} m reaches to {:.0f} m from zero",
                               resolution_m, ndt::kMaxCell * resolution_m));
}

void make_map(const MapArguments& arguments) {
  const auto began = std::chrono::steady_clock::now();
  const std::vector<std::filesystem::path> files = list_clouds_once(arguments.clouds);
  const Eigen::Vector3d origin_m(arguments.origin_m[0], arguments.origin_m[1], arguments.origin_m[2]);
  spare_clouds(files, arguments.output);
  check_origin(origin_m, arguments.resolution_m);
  ndt::VoxelMapBuilder builder(arguments.resolution_m, arguments.capacity);
  visit_clouds(files, [&](const Eigen::Vector3d& point_m) { builder.add(origin_m + point_m); });
  const ndt::MapImage image = builder.build();
  platform::AtomicFile file(arguments.output);
  file.write(image.bytes());
  file.commit();

  const std::size_t voxels = ndt::VoxelMap(image.bytes()).voxels().size();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (arguments.json) {
    const nlohmann::json object{{"points", builder.points()},
                                {"skipped", builder.skipped_points()},
                                {"cells", builder.cells()},
                                {"voxels", voxels},
                                {"bytes", image.bytes().size()},
                                {"resolution_m", arguments.resolution_m},
                                {"seconds", seconds}};
    fmt::print("{}\n", object.dump(2));
    return;
  }
  fmt::print("{}: {} voxels of {} m from {} points, {} bytes, {:.2f} s\n", arguments.output, voxels,
             arguments.resolution_m, builder.points(), image.bytes().size(), seconds);
  if (builder.skipped_points() != 0)
    fmt::print("{} points lie beyond the lattice\n", builder.skipped_points());
}

}  // namespace

void add_map_command(CLI::App& app) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App& command = *app.add_subcommand("map", "voxel map from surveyed point clouds");
  command
      .add_option(
          "--pcd", arguments->clouds,
          "point clouds (ascii, binary, binary_compressed), folders of them, or Autoware's folder of tiles\n"
          "with its pointcloud_map_metadata.yaml")
      ->required()
      ->type_name("FILE|DIR");
  command.add_option("--resolution", arguments->resolution_m, "edge of a voxel [m]")
      ->check(in_range(0.05, 100.0))
      ->type_name("M")
      ->capture_default_str();
  command
      .add_option("--origin", arguments->origin_m,
                  "added to every point, in double precision: where clouds lie whose single-precision\n"
                  "coordinates count from a place of their own")
      ->delimiter(',')
      ->expected(3)
      ->check(in_range(-1e12, 1e12))
      ->type_name("X,Y,Z")
      ->default_str("0,0,0");
  command.add_option("--output", arguments->output, "the map")->required()->type_name("MAP.ndt");
  command
      .add_option("--capacity", arguments->capacity,
                  "cells that the clouds may touch, an error beyond; 80 bytes for each that they do")
      ->check(in_range(std::size_t{1}, std::size_t{1} << 30))
      ->type_name("N")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { make_map(*arguments); });
}

}  // namespace landfix::tools
