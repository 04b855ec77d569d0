// Hesai's packets, written from the user manuals (section 3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator::pandar {

/// How a model writes its data packets.
struct Form {
  std::size_t channels = 0;
  std::size_t blocks = 0;
  bool header = false;          ///< 8 bytes before the blocks; without it FF EE before each
  bool numbered = false;        ///< a sequence number at the end
  int year_zero = 0;            ///< from which the year is counted
  std::int64_t packing_ns = 0;  ///< from the end of the last block to the packet's time
};

/// With the settings of units that were recorded.
inline constexpr Form kPandar64{
    .channels = 64, .blocks = 6, .header = true, .numbered = true, .year_zero = 1900, .packing_ns = 42'580};
inline constexpr Form kPandar40p{.channels = 40, .blocks = 10, .year_zero = 2000, .packing_ns = 28'580};

/// A data packet, little-endian throughout but for its markers, strongest return, 600 rpm:
///   [EE FF, channels, blocks, 0, unit 4 mm, 0, 0]
///   blocks: [FF EE] | azimuth u16 | channels x (distance u16, reflectivity u8)
///   tail of 22: 8: speed u16 | 10: microseconds u32 | 14: return mode | 15: 42 | 16: year to second
///   [sequence u32]
class DataPacket {
 public:
  explicit DataPacket(const Form& form);

  void put_azimuth(std::size_t block, std::uint16_t azimuth_centideg) noexcept;
  void put_return(std::size_t block, std::size_t channel, std::uint16_t range_raw,
                  std::uint8_t reflectivity) noexcept;
  void put_time(std::int64_t utc_ns) noexcept;
  void put_sequence(std::uint32_t sequence) noexcept;

  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  [[nodiscard]] std::size_t azimuth_at(std::size_t block) const noexcept;

  Form form_;
  std::size_t tail_at_;
  std::vector<std::byte> bytes_;
};

/// A GPS packet of 512 bytes, position and pulse valid.
[[nodiscard]] std::vector<std::byte> gps_packet(const GpsFix& fix);

}  // namespace landfix::tools::simulator::pandar
