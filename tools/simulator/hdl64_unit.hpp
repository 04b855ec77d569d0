// The one HDL-64E that the simulator has: its 64 lasers, and the forms in which it says what they are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace landfix::tools::simulator {

/// In the units of the status bytes, which all forms can say exactly. The corrections of the ranges are the
/// same near and far, so that the beams are straight lines.
struct Hdl64UnitLaser {
  int elevation_centideg;
  int rotation_centideg;  ///< to be subtracted from the azimuth
  int range_mm;           ///< to be added to ranges
  int height_mm;          ///< of the beam, at the axis
  int left_mm;            ///< of the beam, from the axis
  int focal_distance_mm;
};

/// Invented, and smooth, but of the proportions of real units. Lasers 0 to 31 are the upper block.
[[nodiscard]] std::array<Hdl64UnitLaser, 64> hdl64_unit();

/// "db.xml" as Velodyne delivers it: degrees, centimetres.
[[nodiscard]] std::string hdl64_db_xml();

/// YAML as ROS drivers read it: radians, metres.
[[nodiscard]] std::string hdl64_yaml();

enum class Hdl64SetKind : std::uint8_t { s2, s3 };

/// The 1820 bytes that the unit sends of itself, seven a cycle of 16 packets.
[[nodiscard]] std::vector<std::uint8_t> hdl64_set(Hdl64SetKind kind);

}  // namespace landfix::tools::simulator
