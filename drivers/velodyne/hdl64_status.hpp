// The HDL-64E's status bytes: with every data packet comes one byte of the unit's state, and 4160 packets
// bring its whole calibration (HDL-64E S3 User's Manual 63-HDL64ES3, appendix E).
//
// A cycle is 16 packets, the type in byte 1204 and the value in byte 1205:
//   H M S D N Y G T V | 1 2 3 4 5 6 7
// The values of the seven, over 260 cycles, are 1820 bytes:
//   0       7                       1792                                    1820
//   | UNIT# | 64 x (laser 21, 7)    | tail: ... 23 return mode, 25 power, 26 checksum |
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/velodyne/hdl64_calibration.hpp"

namespace landfix::drivers::velodyne {

/// What protects a set.
enum class Hdl64Checksum : std::uint8_t {
  constant,  ///< S2: always 1820, the number of bytes
  crc16,     ///< S3: polynomial 0x8005 from 0, unreflected, over the lasers without their numbers
};

/// Gathers the bytes of one whole set; a set that lost a packet or does not check is dropped.
class Hdl64SetCollector {
 public:
  static constexpr std::size_t kBytes = 1820;

  explicit Hdl64SetCollector(Hdl64Checksum checksum) noexcept : checksum_(checksum) {}

  /// The next packet's bytes. True if they complete a sound set: it is in `calibration`.
  [[nodiscard]] bool take(std::uint8_t type, std::uint8_t value, Hdl64Calibration& calibration) noexcept;

 private:
  [[nodiscard]] bool fits(std::uint8_t value) const noexcept;
  [[nodiscard]] bool is_sound(Hdl64Calibration& calibration) const noexcept;

  std::array<std::uint8_t, kBytes> bytes_{};
  std::size_t count_ = 0;
  std::uint8_t last_type_ = 0;
  std::size_t digit_ = 0;  ///< place of the last value among the seven, 1 to 7; 0: unknown
  Hdl64Checksum checksum_;
};

/// Reads the time of day and the date from the packets of one cycle.
class Hdl64Calendar {
 public:
  /// The next packet's bytes. Unix seconds UTC when two cycles have said them, the clock being locked to GPS;
  /// one alone may be damaged.
  [[nodiscard]] std::optional<std::int64_t> take(std::uint8_t type, std::uint8_t value) noexcept;

 private:
  std::array<std::uint8_t, 6> fields_{};  ///< hour, minute, second, day, month, year - 2000
  unsigned known_ = 0;                    ///< a bit a field, of this cycle
  std::optional<std::int64_t> before_s_;  ///< what the cycle before said
};

}  // namespace landfix::drivers::velodyne
