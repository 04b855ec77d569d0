// A simulated drive as files: what the vehicle's LiDAR sent, where it truly was, the map, the configuration.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "tools/simulator/drive.hpp"

namespace landfix::tools::simulator {

struct SimulationSummary {
  double length_m = 0.0;
  double duration_s = 0.0;
  std::size_t data_packets = 0;
  std::size_t telemetry_packets = 0;  ///< position, status, calibration
  std::size_t returns = 0;
  std::size_t map_points = 0;
};

/// Called with the share that is done, from 0 to 1.
using Progress = std::function<void(double)>;

/// Writes capture.pcap, truth.tum, odometry.log, map.pcd, map_projector_info.yaml, config.toml and the unit's
/// calibration, where it has one, to `folder`, which is made if it is missing. The same drive gives the same
/// bytes. Throws std::runtime_error where a file cannot be written.
SimulationSummary write_drive(const Drive& drive, const std::filesystem::path& folder,
                              const Progress& progress);

}  // namespace landfix::tools::simulator
