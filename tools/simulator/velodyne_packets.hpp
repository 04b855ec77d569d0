// Velodyne's packets, written from the manual (VLP-16 User Manual 63-9243 Rev D, section 9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator::velodyne {

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;
inline constexpr std::size_t kBlocks = 12;
/// Flag of a block, as its two bytes read little-endian.
inline constexpr std::uint16_t kUpperBank = 0xEEFF;
inline constexpr std::uint16_t kLowerBank = 0xDDFF;
inline constexpr std::uint8_t kStrongestReturn = 0x37;

/// A data packet of 1206 bytes, little-endian throughout:
///   12 blocks of 100 bytes: flag u16 | azimuth u16 | 32 x (distance u16, reflectivity u8)
///   1200: microseconds since the top of the hour u32 | 1204, 1205: factory bytes
class DataPacket {
 public:
  void put_block(std::size_t block, std::uint16_t flag, std::uint16_t azimuth_centideg) noexcept;
  void put_return(std::size_t block, std::size_t slot, const Echo& echo, double range_unit_m) noexcept;
  void put_time(std::int64_t utc_ns) noexcept;
  /// Return mode and product, except on the HDL-64E.
  void put_factory_bytes(std::uint8_t first, std::uint8_t second) noexcept;
  /// Text in the place of time and factory bytes, as the HDL-64E S1 has it; at most six characters.
  void put_text(std::string_view text) noexcept;

  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(1206);
};

/// A position packet of 512 bytes, with the clock locked to the receiver's pulse.
[[nodiscard]] std::vector<std::byte> position_packet(const GpsFix& fix);

}  // namespace landfix::tools::simulator::velodyne
