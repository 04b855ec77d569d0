#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/velodyne/hdl64_status.hpp"

using landfix::drivers::velodyne::Hdl64Calendar;
using landfix::drivers::velodyne::Hdl64Calibration;
using landfix::drivers::velodyne::Hdl64Checksum;
using landfix::drivers::velodyne::Hdl64SetCollector;

/// The input is a set of calibration bytes, put into sound cycles behind the marker and before the S2's
/// constant checksum; then it is types and values in turn.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view kMarker = "UNIT#";
  constexpr std::string_view kTypes = "HMSDNYGTV";
  const std::span input(data, size);
  Hdl64SetCollector collector(Hdl64Checksum::constant);
  Hdl64Calendar calendar;
  Hdl64Calibration calibration;
  for (std::size_t i = 0; i < Hdl64SetCollector::kBytes; ++i) {
    if (i % 7 == 0) {
      for (const char type : kTypes) {
        const std::uint8_t value = i < size ? input[i] : std::uint8_t{0};
        static_cast<void>(collector.take(static_cast<std::uint8_t>(type), value, calibration));
        static_cast<void>(calendar.take(static_cast<std::uint8_t>(type), value));
      }
    }
    std::uint8_t value = i < size ? input[i] : std::uint8_t{0};
    if (i < kMarker.size()) value = static_cast<std::uint8_t>(kMarker[i]);
    if (i == Hdl64SetCollector::kBytes - 2) value = 0x1C;
    if (i == Hdl64SetCollector::kBytes - 1) value = 0x07;
    if (i >= 7 && i < 1792 && (i - 7) % 28 == 0) value = static_cast<std::uint8_t>((i - 7) / 28);
    const auto type = static_cast<std::uint8_t>('1' + i % 7);
    if (!collector.take(type, value, calibration)) continue;
    for (const auto& laser : calibration.lasers) {
      if (!std::isfinite(laser.elevation_deg + laser.rotation_deg + laser.range_m)) __builtin_trap();
    }
  }
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    static_cast<void>(collector.take(input[i], input[i + 1], calibration));
    static_cast<void>(calendar.take(input[i], input[i + 1]));
  }
  return 0;
}
