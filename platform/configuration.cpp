#include "platform/configuration.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "drivers/sensor_model.hpp"
#include "platform/atomic_file.hpp"
#include "platform/candump_log.hpp"
#include "platform/gnss_configuration.hpp"
#include "platform/ipv4.hpp"
#include "platform/odometry_configuration.hpp"
#include "platform/pose_frame_table.hpp"
#include "platform/toml_section.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kMaxUnixPathLength = 107;

constexpr std::array kSections{"sensor", "vehicle",  "map",     "initial_pose", "filter", "matcher",
                               "can",    "realtime", "metrics", "odometry",     "gnss"};

bool is_ipv4(std::string_view text) { return parse_ipv4(text).has_value(); }

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port != 0;
}

bool is_host_address(std::string_view text) { return text.empty() || is_ipv4(text); }

bool is_multicast_group(std::string_view text) {
  const auto address = parse_ipv4(text);
  return text.empty() || (address && is_multicast(*address));
}

bool is_metrics_address(std::string_view text) {
  constexpr std::string_view kUnix = "unix:";
  if (text.empty()) return true;
  if (text.starts_with(kUnix)) {
    const std::string_view path = text.substr(kUnix.size());
    return path.starts_with('/') && path.size() <= kMaxUnixPathLength &&
           path.find('\0') == std::string_view::npos;
  }
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && is_ipv4(text.substr(0, colon)) && is_port(text.substr(colon + 1));
}

bool is_sensor(std::string_view name) { return drivers::find_sensor_model(name) != nullptr; }

std::string sensor_names() {
  std::vector<std::string_view> names;
  for (const drivers::SensorModel& model : drivers::sensor_models()) names.push_back(model.name);
  return fmt::format("one of {}", fmt::join(names, ", "));
}

void read_sensor(TomlSection section, SensorSettings& sensor) {
  section.require("model");
  section.read("model", sensor.model, is_sensor, sensor_names());
  section.read("calibration", sensor.calibration);
  section.read("address", sensor.address, is_host_address,
               R"(an IPv4 address such as "192.168.1.201", or "")");
  section.read<std::uint16_t>("port", sensor.port, {0, 65535});
  section.read("multicast", sensor.multicast, is_multicast_group,
               R"(an IPv4 multicast group, 224.0.0.0 to 239.255.255.255, or "")");
  section.read("interface", sensor.interface, is_host_address,
               R"(an IPv4 address of this computer such as "192.168.1.100", or "")");
  section.read("receive_buffer_mib", sensor.receive_buffer_mib, {0.25, 1024.0});
  section.read("cut_deg", sensor.cut_deg, {0.0, 360.0});
  section.read("min_range_m", sensor.min_range_m, {0.0, 1000.0});
  section.read("max_range_m", sensor.max_range_m, {0.0, 1000.0});
  section.finish();
  if (sensor.cut_deg == 360.0) section.fail("cut_deg", "less than 360, which is 0");
  if (sensor.max_range_m <= sensor.min_range_m) section.fail("max_range_m", "more than min_range_m");
}

void read_vehicle(TomlSection section, VehicleSettings& vehicle) {
  section.read("sensor_pose", vehicle.sensor_pose);
  section.finish();
}

void read_map(TomlSection section, MapSettings& map) {
  section.read("file", map.file);
  section.read("projector", map.projector);
  section.read("memory_mib", map.memory_mib, {0.0, 1e6});
  section.finish();
}

void read_initial_pose(TomlSection section, InitialPoseSettings& initial_pose) {
  section.read("pose", initial_pose.pose);
  section.read("area", initial_pose.area);
  if (initial_pose.pose && initial_pose.area) section.fail("area", "no area beside a pose");
  section.read("resume", initial_pose.resume);
  section.finish();
}

bool is_filter(std::string_view name) { return ndt::find_filter(name).has_value(); }

void read_filter(TomlSection section, ndt::FilterSettings& filter) {
  std::string kind(ndt::kFilterNames[static_cast<std::size_t>(filter.kind)]);
  section.read("kind", kind, is_filter, fmt::format("one of {}", fmt::join(ndt::kFilterNames, ", ")));
  filter.kind = ndt::find_filter(kind).value();
  section.read("leaf_m", filter.leaf_m, {0.05, 20.0});
  section.read("entropy_share", filter.entropy_share, {0.01, 1.0});
  section.finish();
}

void read_matcher(TomlSection section, MatcherSettings& matcher) {
  section.read("resolution_m", matcher.resolution_m, {0.1, 20.0});
  section.read<int>("max_iterations", matcher.max_iterations, {1, 1000});
  section.read("deadline_ms", matcher.deadline_ms, {0.0, 1000.0});
  section.finish();
}

void read_can(TomlSection section, CanSettings& can) {
  section.read("interface", can.interface, is_can_interface_name,
               "1 to 15 characters without blanks, such as can0");
  section.read<std::uint32_t>("base_id", can.base_id, {1, kMaxBaseId});
  section.read("rate_hz", can.rate_hz, {1.0, 100.0});
  section.read("fd", can.fd);
  section.finish();
}

void read_metrics(TomlSection section, MetricsSettings& metrics) {
  section.read("address", metrics.address, is_metrics_address,
               R"("IPV4:PORT" such as "127.0.0.1:9464", "unix:/PATH", or "")");
  section.finish();
}

void refuse_unknown_sections(const toml::table& root, const std::filesystem::path& path) {
  for (const auto& [key, node] : root) {
    if (std::find(kSections.begin(), kSections.end(), key.str()) != kSections.end()) continue;
    throw std::runtime_error(fmt::format("{}: unknown section or key {}; there are the sections {}",
                                         place(path, key.source()), key.str(), fmt::join(kSections, ", ")));
  }
}

toml::table parse(std::string_view text, const std::filesystem::path& path) {
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", place(path, error.source()), error.description()));
  }
}

}  // namespace

Configuration parse_configuration(std::string_view text, const std::filesystem::path& path) {
  const toml::table root = parse(text, path);
  refuse_unknown_sections(root, path);
  Configuration configuration;
  read_sensor({path, root, "sensor"}, configuration.sensor);
  read_vehicle({path, root, "vehicle"}, configuration.vehicle);
  read_map({path, root, "map"}, configuration.map);
  read_initial_pose({path, root, "initial_pose"}, configuration.initial_pose);
  read_filter({path, root, "filter"}, configuration.filter);
  read_matcher({path, root, "matcher"}, configuration.matcher);
  read_can({path, root, "can"}, configuration.can);
  read_realtime({path, root, "realtime"}, configuration.realtime);
  read_metrics({path, root, "metrics"}, configuration.metrics);
  read_odometry({path, root, "odometry"}, configuration.odometry);
  read_gnss({path, root, "gnss"}, configuration.gnss);
  return configuration;
}

Configuration read_configuration(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return parse_configuration({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace landfix::platform
