// What a sensor says about itself once a second: angles, speed, return mode, firmware (DIFOP; RS-LiDAR-16 and
// -32 User Manuals, appendix on the device information protocol).
//
//   0  magic, 8 bytes        40  top board firmware    300  return mode
//   8  u16 speed setting     45  bottom board firmware 1246  0F F0
// and the angles where the model has them (AngleTable).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/robosense/description.hpp"

namespace landfix::drivers::robosense {

struct LaserAngles {
  double elevation_deg = 0.0;
  double azimuth_offset_deg = 0.0;  ///< clockwise

  [[nodiscard]] bool operator==(const LaserAngles&) const = default;
};
using UnitAngles = std::array<LaserAngles, kMaxLasers>;  ///< in the order of the slots

struct DeviceInfo {
  unsigned motor_rpm = 0;            ///< 0: not set
  std::optional<bool> dual_return;   ///< nothing where the firmware is too old to say
  bool counts_centimetres = false;   ///< as far as the firmware's version tells
  std::optional<UnitAngles> angles;  ///< nothing where the unit has not been programmed
};

/// Whether it begins as device information does, of whichever model.
[[nodiscard]] bool is_device_info(std::span<const std::byte> payload) noexcept;

/// `payload` has kPacketBytes. Answers `telemetry`, or why it is not the model's device information.
[[nodiscard]] DecodeStatus read_device_info(const Description& model, std::span<const std::byte> payload,
                                            DeviceInfo& info) noexcept;

}  // namespace landfix::drivers::robosense
