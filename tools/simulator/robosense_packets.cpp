#include "tools/simulator/robosense_packets.hpp"

#include <chrono>
#include <span>

#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator::robosense {
namespace {

constexpr std::size_t kTimeAt = 20;
constexpr std::size_t kFirstBlockAt = 42;
constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kTailAt = 1246;

constexpr std::size_t kDeviceTimeAt = 303;
constexpr std::size_t kReturnModeAt = 300;

/// Year since 2000, month, day, hour, minute, second, milliseconds u16, microseconds u16.
void put_calendar(std::span<std::byte> bytes, std::size_t at, std::int64_t utc_ns) noexcept {
  using namespace std::chrono;
  const sys_time<nanoseconds> time{nanoseconds(utc_ns)};
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(floor<microseconds>(time - day));
  put_big(bytes, at, static_cast<std::uint64_t>(static_cast<int>(date.year()) - 2000), 1);
  put_big(bytes, at + 1, static_cast<unsigned>(date.month()), 1);
  put_big(bytes, at + 2, static_cast<unsigned>(date.day()), 1);
  put_big(bytes, at + 3, static_cast<std::uint64_t>(clock.hours().count()), 1);
  put_big(bytes, at + 4, static_cast<std::uint64_t>(clock.minutes().count()), 1);
  put_big(bytes, at + 5, static_cast<std::uint64_t>(clock.seconds().count()), 1);
  const auto microseconds_of_second = static_cast<std::uint64_t>(clock.subseconds().count());
  put_big(bytes, at + 6, microseconds_of_second / 1000, 2);
  put_big(bytes, at + 8, microseconds_of_second % 1000, 2);
}

/// Seconds u48, microseconds u32.
void put_seconds(std::span<std::byte> bytes, std::size_t at, std::int64_t utc_ns) noexcept {
  const auto microseconds = static_cast<std::uint64_t>(utc_ns / 1000);
  put_big(bytes, at, microseconds / 1'000'000, 6);
  put_big(bytes, at + 6, microseconds % 1'000'000, 4);
}

}  // namespace

DataPacket::DataPacket(Family family) noexcept : family_(family) {
  if (family == Family::rs_lidar) {
    put_big(bytes_, 0, 0x55AA050A5AA550A0, 8);
  } else {
    put_big(bytes_, 0, 0x55AA055A, 4);
    put_big(bytes_, 4, 1, 2);   // protocol version
    put_big(bytes_, 17, 1, 1);  // units of 0.0025 m
    put_big(bytes_, 31, 6, 1);  // type of sensor: Helios
  }
  put_big(bytes_, kTailAt, 0x00FF, 2);
}

void DataPacket::put_block(std::size_t block, std::uint16_t azimuth_centideg) noexcept {
  put_big(bytes_, kFirstBlockAt + block * kBlockBytes, 0xFFEE, 2);
  put_big(bytes_, kFirstBlockAt + block * kBlockBytes + 2, azimuth_centideg, 2);
}

void DataPacket::put_return(std::size_t block, std::size_t slot, const Echo& echo,
                            double range_unit_m) noexcept {
  const std::size_t at = kFirstBlockAt + block * kBlockBytes + 4 + 3 * slot;
  put_big(bytes_, at, to_range_raw(echo.range_m, range_unit_m), 2);
  put_big(bytes_, at + 2, echo.reflectivity, 1);
}

void DataPacket::put_time(std::int64_t utc_ns) noexcept {
  family_ == Family::rs_lidar ? put_calendar(bytes_, kTimeAt, utc_ns) : put_seconds(bytes_, kTimeAt, utc_ns);
}

DeviceInfoPacket::DeviceInfoPacket(Family family, std::int64_t utc_ns) noexcept {
  put_big(bytes_, 0, 0xA5FF005A11115555, 8);
  put_big(bytes_, 8, 600, 2);                  // speed of the motor
  put_big(bytes_, 10, 0xC0A801C8C0A80166, 8);  // 192.168.1.200 to 192.168.1.102
  put_big(bytes_, 24, kDataPort, 2);
  put_big(bytes_, 28, kDeviceInfoPort, 2);
  put_big(bytes_, 32, 0, 2);  // field of view: the whole turn
  put_big(bytes_, 34, 36000, 2);
  put_big(bytes_, 38, 0, 2);  // phase lock
  put_big(bytes_, 40, 0x0507020100, 5);
  put_big(bytes_, 45, 0x0803060000, 5);
  put_big(bytes_, 291, 0xC1, 1);  // intensities are reflectivities
  put_big(bytes_, 298, 0, 2);
  if (family == Family::rs_lidar) {
    put_big(bytes_, kReturnModeAt, 0x01, 1);
    put_calendar(bytes_, kDeviceTimeAt, utc_ns);
  } else {
    put_big(bytes_, kReturnModeAt, 0x04, 1);
    put_big(bytes_, kReturnModeAt + 1, 0x0001, 2);  // synchronised by GPS
    put_seconds(bytes_, kDeviceTimeAt, utc_ns);
  }
  put_big(bytes_, kTailAt, 0x0FF0, 2);
}

void DeviceInfoPacket::put_angle(std::size_t at, int units) noexcept {
  put_big(bytes_, at, units < 0 ? 1U : 0U, 1);
  put_big(bytes_, at + 1, static_cast<unsigned>(units < 0 ? -units : units), 2);
}

void DeviceInfoPacket::put_magnitude(std::size_t at, unsigned units) noexcept {
  put_big(bytes_, at, units, 3);
}

}  // namespace landfix::tools::simulator::robosense
