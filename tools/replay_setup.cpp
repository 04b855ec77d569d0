#include "tools/replay_setup.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "drivers/make_decoder.hpp"
#include "ndt/map_middle.hpp"
#include "ndt/reach.hpp"
#include "platform/ipv4.hpp"
#include "platform/map_projector_info.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/sensor_setup.hpp"

namespace landfix::tools {
namespace {

[[nodiscard]] drivers::AnyDecoder decoder_for(const drivers::SensorModel& model,
                                              const platform::SensorSettings& sensor) {
  const drivers::DecoderOptions options{
      .cut_deg = sensor.cut_deg, .min_range_m = sensor.min_range_m, .max_range_m = sensor.max_range_m};
  return drivers::make_decoder(model, options, load_calibration(model, sensor.calibration));
}

[[nodiscard]] platform::PipelineSettings settings_for(const platform::Configuration& configuration,
                                                      const drivers::SensorModel& model,
                                                      const ReplayInput& input) {
  const auto& initial_pose = input.initial_pose ? input.initial_pose : configuration.initial_pose.pose;
  platform::PipelineSettings settings{
      .port = configuration.sensor.port != 0 ? configuration.sensor.port : model.data_port,
      .telemetry_port = model.telemetry_port,
      .sensor_address = platform::parse_ipv4(configuration.sensor.address).value_or(0),
      .longest_period_ns = 1'000'000'000 / model.rotation_hz[0],
      .sensor_pose = configuration.vehicle.sensor_pose,
      .filter = configuration.filter,
      .deskew = input.deskew,
      .initial_pose = initial_pose,
      .initial_area = configuration.initial_pose.area,
      .publish = {.can_base_id = configuration.can.base_id, .can_fd = configuration.can.fd},
      .odometry = configuration.odometry,
      .gnss = configuration.gnss};
  settings.localizer.matcher.max_iterations = configuration.matcher.max_iterations;
  return settings;
}

[[nodiscard]] std::filesystem::path map_path(const platform::Configuration& configuration,
                                             const ReplayInput& input) {
  std::filesystem::path path = input.map.empty() ? configuration.map.file : input.map;
  if (path.empty()) throw UsageError("no map: give --map, or [map] file in the configuration");
  return path;
}

/// By which a receiver tells one map from another.
[[nodiscard]] std::uint16_t hash_of(std::uint32_t checksum) {
  return static_cast<std::uint16_t>(checksum ^ checksum >> 16);
}

/// What is told of the map on the bus.
[[nodiscard]] platform::MapReference reference_of(const ReplaySetup& setup) {
  const std::filesystem::path& projector = setup.configuration.map.projector;
  platform::MapReference reference;
  if (!projector.empty()) reference = platform::read_map_projector_info(projector);
  if (setup.configuration.gnss.count != 0 && !reference.projection) {
    throw UsageError(
        "[gnss] needs [map] projector, a map_projector_info.yaml that is not Local: how latitude and "
        "longitude "
        "become the map's x and y");
  }
  reference.hash = hash_of(setup.map_checksum());
  reference.origin = platform::map_origin_near(setup.start_m());
  return reference;
}

/// Where the vehicle is at first, as far as it is known.
[[nodiscard]] std::optional<Eigen::Vector3d> known_start_m(const platform::PipelineSettings& settings) {
  if (settings.initial_pose) return settings.initial_pose->translation();
  if (!settings.initial_area) return std::nullopt;
  const Eigen::Vector2d& middle_m = settings.initial_area->position_m;
  return Eigen::Vector3d(middle_m.x(), middle_m.y(), 0.0);
}

void load_window(ReplaySetup& setup, const std::filesystem::path& path, double memory_bytes) {
  const platform::MapWindowSettings settings{.memory_bytes = static_cast<std::size_t>(memory_bytes),
                                             .reach_m = setup.configuration.sensor.max_range_m};
  setup.window = std::make_unique<platform::MapWindow>(path, settings, known_start_m(setup.settings));
}

/// The map, whole if its memory allows, else a window of it; where the vehicle was seen last decides which.
void add_map(ReplaySetup& setup, const std::filesystem::path& path, const ReplayInput& input) {
  constexpr double kBytes_per_mib = 1 << 20;
  const double memory_bytes = setup.configuration.map.memory_mib * kBytes_per_mib;
  std::error_code no_size;
  const auto file_bytes = static_cast<double>(std::filesystem::file_size(path, no_size));
  const bool is_whole = memory_bytes == 0.0 || no_size || file_bytes <= memory_bytes;
  if (is_whole) {
    setup.image = load_map_file(path);
  } else {
    load_window(setup, path, memory_bytes);
  }
  if (!input.last_pose) return;
  const auto last_pose = input.last_pose(setup.configuration, setup.map_checksum());
  if (!last_pose) return;
  setup.settings.initial_pose = last_pose;
  if (!is_whole) load_window(setup, path, memory_bytes);
}

/// Of a whole map that is not too wide.
void add_search(ReplaySetup& setup) {
  if (setup.window) {
    setup.no_search = "of the map only a window is in memory ([map] memory_mib)";
    return;
  }
  try {
    setup.search = std::make_unique<platform::PlaceSearch>(setup.map());
  } catch (const std::runtime_error& error) {
    setup.no_search = error.what();
  }
}

/// Where there is nothing to begin with, the map must be one that can be searched; an area must be on it.
void check_start(const ReplaySetup& setup) {
  const platform::PipelineSettings& known = setup.settings;
  if (const auto& area = known.initial_area;
      area && !setup.window && !ndt::lowest_m(setup.map(), area->position_m, area->within_m)) {
    throw UsageError(
        fmt::format("[initial_pose] area: the map shows nothing within {} m of x {}, y {}; it counts in the "
                    "frame of the map",
                    area->within_m, area->position_m.x(), area->position_m.y()));
  }
  if (setup.search || known.initial_pose || known.initial_area || known.gnss.count != 0) return;
  throw UsageError(
      fmt::format("where is the vehicle? It cannot be looked for everywhere, as {}: give --initial-pose, or "
                  "[initial_pose] or [[gnss.signal]] in the configuration",
                  setup.no_search));
}

}  // namespace

Eigen::Vector3d ReplaySetup::start_m() const {
  if (const auto known_m = known_start_m(settings)) return *known_m;
  if (window) return window->start_m();
  const ndt::VoxelMap whole = map();
  return ndt::middle_m(whole.blocks(), whole.resolution_m());
}

ReplaySetup prepare_replay(const ReplayInput& input) {
  platform::Configuration configuration = platform::read_configuration(input.config);
  if (input.adjust) input.adjust(configuration);
  const drivers::SensorModel& model = find_sensor(configuration.sensor.model);
  const platform::PipelineSettings settings = settings_for(configuration, model, input);
  const drivers::AnyDecoder decoder = decoder_for(model, configuration.sensor);
  ReplaySetup setup{std::move(configuration), model, settings, decoder, {}, nullptr, nullptr, {}};
  const std::filesystem::path path = map_path(setup.configuration, input);
  add_map(setup, path, input);
  if (setup.settings.initial_pose) setup.settings.initial_area.reset();
  add_search(setup);
  check_start(setup);
  setup.settings.publish.map = reference_of(setup);
  const double resolution_m = setup.map().resolution_m();
  if (resolution_m != setup.configuration.matcher.resolution_m) {
    throw std::runtime_error(fmt::format(
        "{} has a resolution of {} m, [matcher] resolution_m in {} says {} m; they must agree", path.string(),
        resolution_m, input.config.string(), setup.configuration.matcher.resolution_m));
  }
  return setup;
}

}  // namespace landfix::tools
