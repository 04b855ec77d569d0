// RoboSense's packets, written from the manuals (RS-LiDAR-32 User Manual, RS-LiDAR-16 User Manual, chapters 5
// and 6; Helios likewise). Big-endian throughout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator::robosense {

inline constexpr std::uint16_t kDataPort = 6699;
inline constexpr std::uint16_t kDeviceInfoPort = 7788;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kSlots = 32;

enum class Family : std::uint8_t { rs_lidar, helios };

/// A data packet of 1248 bytes: header of 42, time at 20; 12 blocks of 100 (FF EE, azimuth u16, 32 x
/// (distance u16, intensity u8)); 00 FF at the end.
class DataPacket {
 public:
  explicit DataPacket(Family family) noexcept;
  void put_block(std::size_t block, std::uint16_t azimuth_centideg) noexcept;
  void put_return(std::size_t block, std::size_t slot, const Echo& echo, double range_unit_m) noexcept;
  /// A calendar (RS-LiDAR) or seconds (Helios).
  void put_time(std::int64_t utc_ns) noexcept;

  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  Family family_;
  std::vector<std::byte> bytes_ = std::vector<std::byte>(1248);
};

/// Device information of 1248 bytes: 600 rpm, today's firmware, single strongest return; everything else that
/// nobody has set is FF.
class DeviceInfoPacket {
 public:
  DeviceInfoPacket(Family family, std::int64_t utc_ns) noexcept;
  /// Sign 00 or 01 and the magnitude in units of the model.
  void put_angle(std::size_t at, int units) noexcept;
  void put_magnitude(std::size_t at, unsigned units) noexcept;

  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(1248, std::byte{0xFF});
};

}  // namespace landfix::tools::simulator::robosense
