#include "tools/simulator/velodyne_encoder.hpp"

#include <chrono>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace landfix::tools::simulator {
namespace {

// A data packet, little-endian throughout:
//   12 blocks of 100 bytes: flag FF EE | azimuth u16 | 32 x (distance u16, reflectivity u8)
//   1200: microseconds since the top of the hour u32 | 1204: return mode u8 | 1205: product u8
constexpr std::size_t kBlockBytes = 100;
constexpr std::uint16_t kBlockFlag = 0xEEFF;
constexpr std::size_t kTimeAt = 1200;
constexpr std::uint8_t kStrongestReturn = 0x37;
constexpr std::uint8_t kVlp16 = 0x22;

// A position packet of 512 bytes:
//   187: temperatures and calibration | 198: microseconds since the top of the hour u32
//   | 202: state of the pulse u8 | 206: NMEA sentence, CR LF, zeros
constexpr std::size_t kTopBoardAt = 0xBB;
constexpr std::size_t kPositionTimeAt = 0xC6;
constexpr std::size_t kPulseAt = 0xCA;
constexpr std::size_t kNmeaAt = 0xCE;
constexpr std::uint8_t kPulseLocked = 2;
constexpr std::uint8_t kBoardCelsius = 45;

template <class T>
void put(std::span<std::byte> bytes, std::size_t at, T value) noexcept {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[at + i] = static_cast<std::byte>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFF);
  }
}

std::uint32_t top_of_hour_us(std::int64_t utc_ns) noexcept {
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  return static_cast<std::uint32_t>(utc_ns % kHour_ns / 1000);
}

std::string nmea_angle(double angle_deg, int degree_digits, char positive, char negative) {
  const double magnitude_deg = std::abs(angle_deg);
  const int degrees = static_cast<int>(magnitude_deg);
  return fmt::format("{:0{}}{:07.4f},{}", degrees, degree_digits, 60.0 * (magnitude_deg - degrees),
                     angle_deg < 0.0 ? negative : positive);
}

/// The recommended minimum sentence.
std::string rmc(const GpsFix& fix) {
  const std::chrono::sys_seconds second{std::chrono::seconds(fix.utc_ns / 1'000'000'000)};
  constexpr double kKnot_mps = 1852.0 / 3600.0;
  const std::string body =
      fmt::format("GPRMC,{:%H%M%S},A,{},{},{:05.1f},{:05.1f},{:%d%m%y},,,A", second,
                  nmea_angle(fix.latitude_deg, 2, 'N', 'S'), nmea_angle(fix.longitude_deg, 3, 'E', 'W'),
                  fix.speed_mps / kKnot_mps, fix.course_deg, second);
  unsigned checksum = 0;
  for (const char c : body) checksum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\r\n", body, checksum);
}

}  // namespace

DataPayload encode_data(const Vlp16Firings& firings) noexcept {
  DataPayload payload{};
  for (std::size_t block = 0; block < vlp16::kBlocks; ++block) {
    const std::size_t at = block * kBlockBytes;
    put(payload, at, kBlockFlag);
    put(payload, at + 2, firings.azimuth_centideg_raw[block]);
    for (std::size_t i = 0; i < vlp16::kFiringsPerBlock; ++i) {
      const Vlp16Return& one = firings.returns[block * vlp16::kFiringsPerBlock + i];
      put(payload, at + 4 + 3 * i, one.distance_raw);
      put(payload, at + 6 + 3 * i, one.reflectivity_raw);
    }
  }
  put(payload, kTimeAt, top_of_hour_us(firings.first_firing_utc_ns));
  put(payload, kTimeAt + 4, kStrongestReturn);
  put(payload, kTimeAt + 5, kVlp16);
  return payload;
}

PositionPayload encode_position(const GpsFix& fix) {
  PositionPayload payload{};
  put(payload, kTopBoardAt, kBoardCelsius);
  put(payload, kTopBoardAt + 1, kBoardCelsius);
  put(payload, kPositionTimeAt, top_of_hour_us(fix.utc_ns));
  put(payload, kPulseAt, kPulseLocked);
  const std::string sentence = rmc(fix);
  for (std::size_t i = 0; i < sentence.size(); ++i)
    put(payload, kNmeaAt + i, static_cast<std::uint8_t>(sentence[i]));
  return payload;
}

}  // namespace landfix::tools::simulator
