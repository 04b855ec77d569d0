// What one unit says of itself in its metadata file: how its packets are laid out and where its beams point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "drivers/ouster/profile.hpp"

namespace landfix::drivers::ouster {

inline constexpr std::size_t kMaxRows = 128;
inline constexpr std::size_t kMaxColumnsPerFrame = 4096;
inline constexpr std::size_t kMaxColumnsPerPacket = 64;

/// The packet header of every profile but LEGACY, which has none.
enum class HeaderType : std::uint8_t { standard, fusa };

/// Which columns of a turn the sensor sends, both ends included; it wraps where `first` > `last`.
struct ColumnWindow {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] constexpr bool contains(std::size_t column) const noexcept {
    return first <= last ? column >= first && column <= last : column >= first || column <= last;
  }
};

/// One pixel of a column, and the beam that it belongs to.
struct Row {
  double altitude_deg = 0.0;
  double azimuth_deg = 0.0;
  std::uint16_t ring = 0;  ///< rank of the altitude among the beams there are
  bool present = false;    ///< firmware up to 1.13 sends 64 rows of 16 and 32 beams
};

struct Metadata {
  Profile profile = Profile::legacy;
  HeaderType header_type = HeaderType::standard;
  std::size_t row_count = 0;   ///< pixels of a column
  std::size_t beam_count = 0;  ///< rows that are present
  std::array<Row, kMaxRows> rows{};
  std::size_t columns_per_packet = 16;
  std::size_t columns_per_frame = 1024;
  ColumnWindow window{.first = 0, .last = 1023};
  int frames_per_s = 10;
  std::uint64_t serial_number = 0;  ///< 0: not told

  // Where the beams start, in the lidar frame at encoder angle 0 [mm].
  double beam_origin_x_mm = 0.0;
  double beam_origin_z_mm = 0.0;
  /// `sensor <- lidar`, row-major, translation in mm.
  std::array<double, 16> lidar_to_sensor{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
};
static_assert(std::is_trivially_copyable_v<Metadata>);

}  // namespace landfix::drivers::ouster
