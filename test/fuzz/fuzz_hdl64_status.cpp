#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/velodyne/hdl64_status.hpp"

namespace {

using landfix::drivers::velodyne::Hdl64Calendar;
using landfix::drivers::velodyne::Hdl64Calibration;
using landfix::drivers::velodyne::Hdl64Checksum;
using landfix::drivers::velodyne::Hdl64SetCollector;
using Bytes = std::span<const std::uint8_t>;
using Set = std::array<std::uint8_t, Hdl64SetCollector::kBytes>;

constexpr std::string_view kCalendar = "HMSDNYG";
constexpr std::string_view kCycle = "HMSDNYGTV";
constexpr std::size_t kDigits = 7;

constexpr std::size_t kLaserAt = 7;
constexpr std::size_t kLaserStep = 28;
/// The last two lasers and the tail: a set from its start on takes twenty times as long, and tells little
/// more.
constexpr std::size_t kLate = kLaserAt + 62 * kLaserStep;

/// From `first` on the input where a set is free, its first byte the power level too; the marker, the numbers
/// of the lasers and the S2's checksum where not.
Set make_set(Bytes input, std::size_t first) {
  constexpr std::string_view kMarker = "UNIT#";
  Set set{};
  std::copy_n(input.begin(), std::min(input.size(), set.size() - first), set.begin() + first);
  std::ranges::copy(kMarker, set.begin());
  for (std::uint8_t laser = 0; laser < 64; ++laser) set[kLaserAt + kLaserStep * laser] = laser;
  if (!input.empty()) set[set.size() - 3] = input[0];
  set[set.size() - 2] = 0x1C;
  set[set.size() - 1] = 0x07;
  return set;
}

struct Receiver {
  Hdl64SetCollector collector{Hdl64Checksum::constant};
  Hdl64Calibration calibration;

  void take(std::uint8_t type, std::uint8_t value) {
    if (!collector.take(type, value, calibration)) return;
    for (const auto& laser : calibration.lasers) {
      if (!std::isfinite(laser.elevation_deg + laser.rotation_deg + laser.range_m)) __builtin_trap();
    }
  }
  /// Bytes `first` to `last` of a set, `first` beginning a cycle.
  void take(const Set& set, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (i % kDigits == 0) {
        for (const char type : kCycle) take(static_cast<std::uint8_t>(type), set[i]);
      }
      take(static_cast<std::uint8_t>('1' + i % kDigits), set[i]);
    }
  }
};

}  // namespace

/// The input is the bytes of a calibration set, mostly of its end; then it is times of day and dates; then
/// types and values in turn.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Receiver late = [] {
    Receiver receiver;
    receiver.take(make_set({}, 0), 0, kLate);
    return receiver;
  }();
  const Bytes input(data, size);
  const bool whole = size != 0 && input[0] == 0xFF;
  Receiver receiver = whole ? Receiver{} : late;
  const std::size_t first = whole ? 0 : kLate;
  receiver.take(make_set(input, first), first, Hdl64SetCollector::kBytes);

  Hdl64Calendar calendar;
  for (std::size_t i = 0; i < size; ++i) {
    static_cast<void>(calendar.take(static_cast<std::uint8_t>(kCalendar[i % kCalendar.size()]), input[i]));
  }
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    receiver.take(input[i], input[i + 1]);
    static_cast<void>(calendar.take(input[i], input[i + 1]));
  }
  return 0;
}
