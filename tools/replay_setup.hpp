// From a configuration to what a replay needs, each part checked.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "drivers/any_decoder.hpp"
#include "drivers/sensor_model.hpp"
#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/configuration.hpp"
#include "platform/map_window.hpp"
#include "platform/pipeline.hpp"

namespace landfix::tools {

/// What the command line says beside the configuration.
struct ReplayInput {
  std::filesystem::path config;
  std::filesystem::path map{};              ///< empty: the configuration's
  std::optional<ndt::Pose> initial_pose{};  ///< nothing: the configuration's
  bool deskew = true;
};

struct ReplaySetup {
  platform::Configuration configuration;
  const drivers::SensorModel& model;
  platform::PipelineSettings settings;
  drivers::AnyDecoder decoder;
  ndt::MapImage image;                          ///< the whole map, or none
  std::unique_ptr<platform::MapWindow> window;  ///< where the map is larger than its memory

  [[nodiscard]] ndt::VoxelMap map() const {
    return window ? window->newest(window->start_m()) : ndt::VoxelMap(image.bytes());
  }
  /// Where the vehicle is at first, or the middle of the map.
  [[nodiscard]] Eigen::Vector3d start_m() const;
  /// That covers all of the map.
  [[nodiscard]] std::uint32_t map_checksum() const {
    return window ? window->map_checksum() : map().header().header_checksum;
  }
};

/// Throws UsageError where the map or the initial pose is given nowhere, or what a section needs of another;
/// std::runtime_error where a file does not do.
[[nodiscard]] ReplaySetup prepare_replay(const ReplayInput& input);

}  // namespace landfix::tools
