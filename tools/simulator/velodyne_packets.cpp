#include "tools/simulator/velodyne_packets.hpp"

#include <string>

#include "tools/simulator/nmea_sentence.hpp"
#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator::velodyne {
namespace {

constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kTimeAt = 1200;

// A position packet of 512 bytes:
//   187: temperatures and calibration | 198: microseconds since the top of the hour u32
//   | 202: state of the pulse u8 | 206: NMEA sentence, CR LF, zeros
constexpr std::size_t kTopBoardAt = 0xBB;
constexpr std::size_t kPositionTimeAt = 0xC6;
constexpr std::size_t kPulseAt = 0xCA;
constexpr std::size_t kNmeaAt = 0xCE;
constexpr std::uint8_t kPulseLocked = 2;
constexpr std::uint8_t kBoardCelsius = 45;

std::uint32_t top_of_hour_us(std::int64_t utc_ns) noexcept {
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  return static_cast<std::uint32_t>(utc_ns % kHour_ns / 1000);
}

}  // namespace

void DataPacket::put_block(std::size_t block, std::uint16_t flag, std::uint16_t azimuth_centideg) noexcept {
  put_little(bytes_, block * kBlockBytes, flag, 2);
  put_little(bytes_, block * kBlockBytes + 2, azimuth_centideg, 2);
}

void DataPacket::put_return(std::size_t block, std::size_t slot, const Echo& echo,
                            double range_unit_m) noexcept {
  const std::size_t at = block * kBlockBytes + 4 + 3 * slot;
  put_little(bytes_, at, to_range_raw(echo.range_m, range_unit_m), 2);
  put_little(bytes_, at + 2, echo.reflectivity, 1);
}

void DataPacket::put_time(std::int64_t utc_ns) noexcept {
  put_little(bytes_, kTimeAt, top_of_hour_us(utc_ns), 4);
}

void DataPacket::put_factory_bytes(std::uint8_t first, std::uint8_t second) noexcept {
  put_little(bytes_, kTimeAt + 4, first, 1);
  put_little(bytes_, kTimeAt + 5, second, 1);
}

void DataPacket::put_text(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size() && i < 6; ++i) {
    bytes_[kTimeAt + i] = static_cast<std::byte>(text[i]);
  }
}

std::vector<std::byte> position_packet(const GpsFix& fix) {
  std::vector<std::byte> payload(512);
  put_little(payload, kTopBoardAt, kBoardCelsius, 1);
  put_little(payload, kTopBoardAt + 1, kBoardCelsius, 1);
  put_little(payload, kPositionTimeAt, top_of_hour_us(fix.utc_ns), 4);
  put_little(payload, kPulseAt, kPulseLocked, 1);
  const std::string sentence = nmea_sentence(fix);
  for (std::size_t i = 0; i < sentence.size(); ++i)
    payload[kNmeaAt + i] = static_cast<std::byte>(sentence[i]);
  return payload;
}

}  // namespace landfix::tools::simulator::velodyne
