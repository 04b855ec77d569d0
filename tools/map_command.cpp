// landfix map: a voxel map from surveyed point clouds.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ndt/pcd.hpp"
#include "ndt/voxel_map.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "platform/atomic_file.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

struct Arguments {
  std::vector<std::string> clouds;
  std::string output;
  double resolution_m = 1.0;
  std::size_t capacity = kMapCapacity;
  bool json = false;
};

void make_map(const Arguments& arguments) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<std::filesystem::path> files;
  for (const std::string& cloud : arguments.clouds) {
    const auto found = list_clouds(cloud);
    files.insert(files.end(), found.begin(), found.end());
  }
  ndt::VoxelMapBuilder builder(arguments.resolution_m, arguments.capacity);
  for (std::size_t i = 0; i < files.size(); ++i) {
    show_progress(fmt::format("reading {} of {} clouds, {} points", i + 1, files.size(), builder.points()));
    ndt::visit_pcd_positions(platform::read_file(files[i]), files[i].string(),
                             [&builder](const Eigen::Vector3d& point_m) { builder.add(point_m); });
  }
  show_progress("");
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
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("map", "voxel map from surveyed point clouds");
  command
      .add_option("--pcd", arguments->clouds,
                  "point clouds, or folders of them (ascii, binary, binary_compressed)")
      ->required()
      ->type_name("FILE|DIR...");
  command.add_option("--resolution", arguments->resolution_m, "edge of a voxel [m]")
      ->check(CLI::Range(0.05, 100.0).description(""))
      ->type_name("M")
      ->capture_default_str();
  command.add_option("--output", arguments->output, "the map")->required()->type_name("MAP.ndt");
  command
      .add_option("--capacity", arguments->capacity,
                  "cells that the clouds may touch; memory is set aside for them")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 30).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { make_map(*arguments); });
}

}  // namespace landfix::tools
