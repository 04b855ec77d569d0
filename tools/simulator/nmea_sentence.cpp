#include "tools/simulator/nmea_sentence.hpp"

#include <chrono>
#include <cmath>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace landfix::tools::simulator {
namespace {

std::string nmea_angle(double angle_deg, int degree_digits, char positive, char negative) {
  const double magnitude_deg = std::abs(angle_deg);
  const int degrees = static_cast<int>(magnitude_deg);
  return fmt::format("{:0{}}{:07.4f},{}", degrees, degree_digits, 60.0 * (magnitude_deg - degrees),
                     angle_deg < 0.0 ? negative : positive);
}

}  // namespace

std::string nmea_sentence(const GpsFix& fix) {
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

}  // namespace landfix::tools::simulator
