// Ouster's packets, written from the vendor's sensor documentation: every UDP profile, both packet headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator::ouster {

inline constexpr std::uint16_t kLidarPort = 7502;
inline constexpr std::uint16_t kImuPort = 7503;
inline constexpr std::size_t kColumnsPerPacket = 16;

enum class Profile : std::uint8_t {
  legacy,
  single,
  dual,
  low_rate,
  low_rate_dual_fusa,
  low_rate_dual,
  single_zones,
  dual_zones,
  low_rate_zones,
  low_rate_window,
  five_words,
  single_colour,
  dual_colour,
};
inline constexpr std::size_t kProfileCount = 13;

/// `udp_profile_lidar` of the metadata.
[[nodiscard]] std::string_view name_of(Profile profile) noexcept;
[[nodiscard]] bool has_second_return(Profile profile) noexcept;

/// What is the same in all packets of a unit.
struct PacketFormat {
  Profile profile = Profile::single;
  bool fusa_header = false;
  bool checksum = true;  ///< else zeros, as firmware 2.2 and the FUSA header have it
  std::size_t rows = 64;
  std::size_t columns_per_turn = 1024;
  std::uint64_t serial_number = 0;
  std::uint32_t init_id = 0;
};

struct PacketMoment {
  std::uint32_t frame_id = 0;
  std::size_t first_column = 0;
  std::int64_t utc_ns = 0;  ///< of the first column
  std::int64_t column_ns = 0;
};

/// `echoes`: row by row, column by column, their ranges from the axis of rotation on; `second` likewise, or
/// nothing.
[[nodiscard]] std::vector<std::byte> lidar_packet(const PacketFormat& format, const PacketMoment& moment,
                                                  std::span<const Echo> echoes,
                                                  std::span<const Echo> second = {});

/// At rest, upright: 48 bytes.
[[nodiscard]] std::vector<std::byte> imu_packet(std::int64_t utc_ns);
/// The same with firmware 3.2 on: four measurements and an NMEA sentence.
[[nodiscard]] std::vector<std::byte> nmea_imu_packet(const PacketFormat& format, std::int64_t utc_ns);

}  // namespace landfix::tools::simulator::ouster
