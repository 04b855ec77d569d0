#include "tools/replay_setup.hpp"

#include <stdexcept>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "drivers/make_decoder.hpp"
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

/// Host byte order; 0 where there is none. The configuration has checked what there is.
[[nodiscard]] std::uint32_t ipv4_of(const std::string& text) {
  in_addr address{};
  if (!text.empty()) ::inet_pton(AF_INET, text.c_str(), &address);
  return ntohl(address.s_addr);
}

[[nodiscard]] platform::PipelineSettings settings_for(const platform::Configuration& configuration,
                                                      const drivers::SensorModel& model,
                                                      const ReplayInput& input) {
  const auto& initial_pose = input.initial_pose ? input.initial_pose : configuration.initial_pose.pose;
  if (!initial_pose) {
    throw UsageError("no initial pose: give --initial-pose, or [initial_pose] pose in the configuration");
  }
  platform::PipelineSettings settings{
      .port = configuration.sensor.port != 0 ? configuration.sensor.port : model.data_port,
      .telemetry_port = model.telemetry_port,
      .sensor_address = ipv4_of(configuration.sensor.address),
      .points_per_sweep = model.max_points_per_sweep(),
      .sensor_pose = configuration.vehicle.sensor_pose,
      .filter = configuration.filter,
      .deskew = input.deskew,
      .initial_pose = *initial_pose,
      .can_base_id = configuration.can.base_id};
  settings.localizer.matcher.max_iterations = configuration.matcher.max_iterations;
  return settings;
}

[[nodiscard]] ndt::MapImage map_for(const platform::Configuration& configuration, const ReplayInput& input) {
  const std::filesystem::path path = input.map.empty() ? configuration.map.file : input.map;
  if (path.empty()) throw UsageError("no map: give --map, or [map] file in the configuration");
  ndt::MapImage image = load_map_file(path);
  const double resolution_m = ndt::VoxelMap(image.bytes()).resolution_m();
  if (resolution_m != configuration.matcher.resolution_m) {
    throw std::runtime_error(
        fmt::format("{} has a resolution of {} m, [matcher] resolution_m in {} says {} m; they must agree",
                    path.string(), resolution_m, input.config.string(), configuration.matcher.resolution_m));
  }
  return image;
}

}  // namespace

ReplaySetup prepare_replay(const ReplayInput& input) {
  platform::Configuration configuration = platform::read_configuration(input.config);
  const drivers::SensorModel& model = find_sensor(configuration.sensor.model);
  const platform::PipelineSettings settings = settings_for(configuration, model, input);
  const drivers::AnyDecoder decoder = decoder_for(model, configuration.sensor);
  ndt::MapImage image = map_for(configuration, input);
  return {std::move(configuration), model, settings, decoder, std::move(image)};
}

}  // namespace landfix::tools
