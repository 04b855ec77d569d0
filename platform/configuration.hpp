// The configuration file, checked: who holds a Configuration need not doubt its values. config/landfix.toml
// explains every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ndt/pose.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/scan_filter.hpp"
#include "platform/gnss.hpp"
#include "platform/odometry.hpp"
#include "platform/realtime_settings.hpp"

namespace landfix::platform {

struct SensorSettings {
  std::string model;                  ///< of the catalogue; required
  std::filesystem::path calibration;  ///< empty: the model's own angles
  std::string address;                ///< IPv4 of the sensor; empty: whoever sends
  std::uint16_t port = 0;             ///< UDP destination of its packets; 0: the model's
  std::string multicast;              ///< group to which it sends; empty: unicast or broadcast
  std::string interface;              ///< IPv4 of this computer at which it arrives; empty: any
  double receive_buffer_mib = 16.0;   ///< of the kernel, for what arrives while the program does not read
  double cut_deg = 0.0;               ///< azimuth between sweeps, clockwise from the front, [0, 360)
  double min_range_m = 3.0;
  double max_range_m = 200.0;
};

struct VehicleSettings {
  ndt::Pose sensor_pose = ndt::Pose::Identity();  ///< vehicle <- sensor
};

struct MapSettings {
  std::filesystem::path file;       ///< empty: must come from elsewhere
  std::filesystem::path projector;  ///< Autoware's map_projector_info.yaml; empty: none
  double memory_mib = 0.0;          ///< that a map may take, else a window of it; 0: as much as it needs
};

struct InitialPoseSettings {
  // Nothing of these, and nothing from elsewhere: anywhere on the map.
  std::optional<ndt::Pose> pose;       ///< map <- vehicle
  std::optional<ndt::PoseGuess> area;  ///< the vehicle is somewhere in it
  std::filesystem::path resume;        ///< where landfixd keeps the last good pose; empty: nowhere
};

struct MatcherSettings {
  double resolution_m = 1.0;  ///< the map's
  int max_iterations = 50;
  double deadline_ms = 50.0;  ///< from a sweep's last packet to the end of its match; 0: none
};

struct CanSettings {
  std::string interface = "can0";
  std::uint32_t base_id = 0x3A0;  ///< of the first frame, 11 bits
  double rate_hz = 10.0;          ///< of the poses on a live bus; a replay logs one for each sweep
  bool fd = false;                ///< each pose as one frame of CAN FD instead of six of classic CAN
};

struct MetricsSettings {
  std::string address;  ///< "IPV4:PORT" or "unix:/PATH"; empty: no metrics
};

struct Configuration {
  SensorSettings sensor{};
  VehicleSettings vehicle{};
  MapSettings map{};
  InitialPoseSettings initial_pose{};
  ndt::FilterSettings filter{};
  MatcherSettings matcher{};
  CanSettings can{};
  RealtimeSettings realtime{};
  MetricsSettings metrics{};
  OdometrySettings odometry{};
  GnssSettings gnss{};
};

/// Paths within the file are relative to its folder. Throws std::runtime_error: path:line:column, what is
/// wrong, and what is allowed. Unknown keys are errors too.
[[nodiscard]] Configuration read_configuration(const std::filesystem::path& path);
[[nodiscard]] Configuration parse_configuration(std::string_view text, const std::filesystem::path& path);

}  // namespace landfix::platform
