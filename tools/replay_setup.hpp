// From a configuration to what a replay needs, each part checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "drivers/any_decoder.hpp"
#include "drivers/sensor_model.hpp"
#include "ndt/map_image.hpp"
#include "ndt/pose.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/configuration.hpp"
#include "platform/map_aids.hpp"
#include "platform/map_window.hpp"
#include "platform/pipeline.hpp"
#include "platform/place_search.hpp"

namespace landfix::tools {

/// What the command line says beside the configuration.
struct ReplayInput {
  std::filesystem::path config;
  std::filesystem::path map{};              ///< empty: the configuration's
  std::optional<ndt::Pose> initial_pose{};  ///< nothing: the configuration's
  /// The pose to go on from in place of both, by the map's checksum; nothing: none.
  std::function<std::optional<ndt::Pose>(const platform::Configuration&, std::uint32_t)> last_pose{};
  bool deskew = true;
  std::function<void(platform::Configuration&)> adjust{};  ///< the configuration, before it is used
};

struct ReplaySetup {
  platform::Configuration configuration;
  const drivers::SensorModel& model;
  platform::PipelineSettings settings;
  drivers::AnyDecoder decoder;
  ndt::MapImage image;                          ///< the whole map, or none
  std::unique_ptr<platform::MapWindow> window;  ///< where the map is larger than its memory
  std::unique_ptr<platform::PlaceSearch> search;
  std::string no_search;  ///< why there is none

  [[nodiscard]] ndt::VoxelMap map() const {
    return window ? window->newest(window->start_m()) : ndt::VoxelMap(image.bytes());
  }
  [[nodiscard]] platform::MapAids aids() const { return {.window = window.get(), .search = search.get()}; }
  /// Where the vehicle is at first, as far as that is known, or the middle of the map.
  [[nodiscard]] Eigen::Vector3d start_m() const;
  /// That covers all of the map.
  [[nodiscard]] std::uint32_t map_checksum() const {
    return window ? window->map_checksum() : map().header().header_checksum;
  }
};

/// Throws UsageError where the map is given nowhere, nor a place to begin with on one that cannot be
/// searched, an area that the map does not show, or what a section needs of another; std::runtime_error where
/// a file does not do.
[[nodiscard]] ReplaySetup prepare_replay(const ReplayInput& input);

}  // namespace landfix::tools
