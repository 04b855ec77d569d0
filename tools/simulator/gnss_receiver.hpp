// What a satellite receiver would say of the drive on the vehicle's bus, and where on earth the routes are.
#pragma once

#include <array>
#include <string>

#include "platform/can_frame.hpp"
#include "platform/map_projection.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {

/// About 1.5 m wrong, as without corrections, its heading, of two antennas, 0.7 deg, both with noise.
class GnssReceiver {
 public:
  explicit GnssReceiver(const Drive& drive);

  /// Position; heading and altitude.
  [[nodiscard]] std::array<platform::CanFrame, 2> frames_at(double time_s);

 private:
  const Drive& drive_;
  platform::MapProjection projection_;
  Random noise_;
};

/// The section of the configuration that reads it.
[[nodiscard]] std::string gnss_section();
/// The map_projector_info.yaml of all routes.
[[nodiscard]] std::string projector_info();

}  // namespace landfix::tools::simulator
