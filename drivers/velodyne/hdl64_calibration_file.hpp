// The calibration file of one HDL-64E: the db.xml that it was delivered with, or the YAML that ROS drivers
// keep of it.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "drivers/velodyne/hdl64_calibration.hpp"

namespace landfix::drivers::velodyne {

/// Reads either format; whichever begins with '<' is XML. `name` is for messages. Throws std::runtime_error
/// with `name`, the line, what is wrong and what to do.
[[nodiscard]] Hdl64Calibration parse_hdl64_calibration(std::span<const std::byte> file,
                                                       std::string_view name);

/// db.xml: degrees, centimetres; lasers may be switched off.
[[nodiscard]] Hdl64Calibration parse_hdl64_db_xml(std::string_view text, std::string_view name);

/// YAML: radians, metres; lasers that are switched off are not in it.
[[nodiscard]] Hdl64Calibration parse_hdl64_yaml(std::string_view text, std::string_view name);

/// A number of a file, finite. `what` names it in the message.
[[nodiscard]] double parse_number(std::string_view text, std::string_view what, std::string_view name,
                                  std::size_t line);

/// Puts a laser into its place. Throws where its numbers cannot be a laser's.
void place_laser(const Hdl64Laser& laser, std::size_t id, std::string_view name, std::size_t line,
                 Hdl64Calibration& calibration);

/// A bound of intensity, 0 to 255.
[[nodiscard]] std::uint8_t parse_intensity(std::string_view text, std::string_view what,
                                           std::string_view name, std::size_t line);

}  // namespace landfix::drivers::velodyne
