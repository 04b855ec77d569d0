// Ouster's lidar packet. Everything is little-endian; C columns of a packet, H pixels of a column.
//
//   LEGACY:  C x | u64 time | u16 column | u16 frame | u32 encoder | H x 12 bytes | u32 status |
//   others:  header 32 | C x | u64 time | u16 column | u16 status | H x pixel | | 24 zeros | u64 CRC |
//
//   STANDARD header: | u16 type | u16 frame | u24 init id | u40 serial | ...
//   FUSA header:     | u8 type | u24 init id | u32 frame | u8 alerts | u8 0 | u8 safe state | u40 serial |
//   ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/little_endian.hpp"
#include "drivers/ouster/metadata.hpp"

namespace landfix::drivers::ouster {

inline constexpr std::size_t kHeaderBytes = 32;
inline constexpr std::size_t kFooterBytes = 32;
inline constexpr std::size_t kCrcBytes = 8;
inline constexpr std::size_t kColumnHeaderBytes = 12;
inline constexpr std::size_t kLegacyColumnHeaderBytes = 16;
inline constexpr std::size_t kLegacyStatusBytes = 4;
/// The encoder's ticks a turn: it repeats the column's number.
inline constexpr std::uint32_t kEncoderTicks = 90112;

inline constexpr std::size_t kLegacyImuBytes = 48;
inline constexpr std::size_t kZoneBytes = 680;
/// Header, NMEA sentence and footer; so many more a measurement.
inline constexpr std::size_t kImuBytes = 164;
inline constexpr std::size_t kImuMeasurementBytes = 36;

enum class PacketType : std::uint8_t { lidar = 1, imu = 2, zones = 3 };

/// Where things lie in the packets of one profile.
struct PacketShape {
  std::size_t first_column_at = 0;
  std::size_t columns = 0;
  std::size_t column_bytes = 0;
  std::size_t first_pixel_at = 0;  ///< in the column
  std::size_t packet_bytes = 0;
};

[[nodiscard]] constexpr PacketShape packet_shape(Profile profile, std::size_t rows,
                                                 std::size_t columns) noexcept {
  const std::size_t pixels = rows * pixel_of(profile).bytes;
  if (profile == Profile::legacy) {
    const std::size_t column = kLegacyColumnHeaderBytes + pixels + kLegacyStatusBytes;
    return {.first_column_at = 0,
            .columns = columns,
            .column_bytes = column,
            .first_pixel_at = kLegacyColumnHeaderBytes,
            .packet_bytes = columns * column};
  }
  const std::size_t column = kColumnHeaderBytes + pixels;
  return {.first_column_at = kHeaderBytes,
          .columns = columns,
          .column_bytes = column,
          .first_pixel_at = kColumnHeaderBytes,
          .packet_bytes = kHeaderBytes + columns * column + kFooterBytes};
}
static_assert(packet_shape(Profile::legacy, 64, 16).packet_bytes == 12608);
static_assert(packet_shape(Profile::dual, 128, 16).packet_bytes == 33024);

struct PacketHeader {
  std::uint32_t type = 0;
  std::uint32_t frame_id = 0;
  std::uint32_t init_id = 0;  ///< another after each start of the sensor
  std::uint64_t serial_number = 0;
};

/// Of at least kHeaderBytes.
[[nodiscard]] inline PacketHeader read_header(const std::byte* bytes, HeaderType type) noexcept {
  if (type == HeaderType::fusa) {
    return {.type = std::to_integer<std::uint32_t>(bytes[0]),
            .frame_id = load_little_endian<std::uint32_t>(bytes + 4),
            .init_id = load_little_endian<std::uint32_t, 3>(bytes + 1),
            .serial_number = load_little_endian<std::uint64_t, 5>(bytes + 11)};
  }
  return {.type = load_little_endian<std::uint16_t>(bytes),
          .frame_id = load_little_endian<std::uint16_t>(bytes + 2),
          .init_id = load_little_endian<std::uint32_t, 3>(bytes + 4),
          .serial_number = load_little_endian<std::uint64_t, 5>(bytes + 7)};
}

struct ColumnHeader {
  std::uint64_t time_ns = 0;
  std::uint16_t id = 0;        ///< azimuth index within the turn
  std::uint16_t frame_id = 0;  ///< LEGACY only
  bool valid = false;          ///< only then its pixels count; time and id are there all the same
};

[[nodiscard]] inline ColumnHeader read_column(const std::byte* column, const PacketShape& shape,
                                              bool legacy) noexcept {
  ColumnHeader header{.time_ns = load_little_endian<std::uint64_t>(column),
                      .id = load_little_endian<std::uint16_t>(column + 8)};
  if (legacy) {
    header.frame_id = load_little_endian<std::uint16_t>(column + 10);
    header.valid =
        (load_little_endian<std::uint32_t>(column + shape.column_bytes - kLegacyStatusBytes) & 1U) != 0;
  } else {
    header.valid = (load_little_endian<std::uint16_t>(column + 10) & 1U) != 0;
  }
  return header;
}

/// Whether a payload is one of the sensor's packets that hold no points: of the IMU, or of zones.
[[nodiscard]] inline bool is_telemetry(std::span<const std::byte> payload, HeaderType header_type) noexcept {
  const std::size_t size = payload.size();
  if (size == kLegacyImuBytes) return true;
  if (size < kHeaderBytes) return false;
  const auto type = static_cast<PacketType>(read_header(payload.data(), header_type).type);
  if (type == PacketType::imu) return size >= kImuBytes && (size - kImuBytes) % kImuMeasurementBytes == 0;
  return type == PacketType::zones && size == kZoneBytes;
}

}  // namespace landfix::drivers::ouster
