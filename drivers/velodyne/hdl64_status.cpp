#include "drivers/velodyne/hdl64_status.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <string_view>
#include <utility>

#include "drivers/civil_time.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr std::string_view kMarker = "UNIT#";
constexpr std::string_view kCalendar = "HMSDNY";
constexpr std::string_view kCycle = "HMSDNYGTV";
constexpr std::size_t kDigits = 7;
constexpr std::size_t kLaserAt = 7;
constexpr std::size_t kLaserStep = 28;
constexpr std::size_t kLaserBytes = 21;
constexpr std::size_t kPowerAt = 1792 + 25;
constexpr std::size_t kChecksumAt = 1792 + 26;
/// The sensor corrects the intensities itself; 0xA0 to 0xA7 are fixed powers, at which it does not.
constexpr std::uint8_t kCorrectedInside = 0xA8;
constexpr std::uint8_t kGpsLocked = 'A';  // pulse and time

using Bytes = std::span<const std::uint8_t>;

std::uint16_t unsigned16(Bytes bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8));
}
double signed16(Bytes bytes, std::size_t at) noexcept {
  return std::bit_cast<std::int16_t>(unsigned16(bytes, at));
}

Bytes laser_bytes(Bytes set, std::size_t laser) noexcept {
  return set.subspan(kLaserAt + laser * kLaserStep, kLaserBytes);
}

constexpr std::uint16_t crc16(std::uint16_t crc, std::uint8_t byte) noexcept {
  crc = static_cast<std::uint16_t>(crc ^ (byte << 8));
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? (crc << 1) ^ 0x8005 : crc << 1);
  }
  return crc;
}

/// The check value that catalogues of CRCs give for this one (CRC-16/UMTS).
static_assert([] {
  std::uint16_t crc = 0;
  for (std::uint8_t digit = '1'; digit <= '9'; ++digit) crc = crc16(crc, digit);
  return crc;
}() == 0xFEE8);

std::uint16_t crc16_of_lasers(Bytes set) noexcept {
  std::uint16_t crc = 0;
  for (std::size_t laser = 0; laser < kHdl64Lasers; ++laser) {
    for (const std::uint8_t byte : laser_bytes(set, laser).subspan(1)) crc = crc16(crc, byte);
  }
  return crc;
}

Hdl64Laser read_laser(Bytes record) noexcept {
  Hdl64Laser laser{.elevation_deg = 0.01 * signed16(record, 1)};
  laser.rotation_deg = 0.01 * signed16(record, 3);
  laser.range_m = 0.001 * signed16(record, 5);
  laser.range_x_m = 0.001 * signed16(record, 7);
  laser.range_y_m = 0.001 * signed16(record, 9);
  laser.vertical_offset_m = 0.001 * signed16(record, 11);
  laser.horizontal_offset_m = 0.001 * signed16(record, 13);
  laser.focal_distance_m = 0.001 * signed16(record, 15);
  laser.focal_slope = 0.1 * signed16(record, 17);
  laser.min_intensity = record[19];
  laser.max_intensity = record[20];
  complete_two_point(laser);
  return laser;
}

/// Place of a type among the seven after the one before it; 0 if it is none that may follow. The S3 sends its
/// warnings in the place of a first, and types of its own (0xF8 and on) for most of the tail.
std::size_t place_among_seven(std::uint8_t type, std::size_t before) noexcept {
  const std::size_t next = before % kDigits + 1;
  const bool is_next = type == '0' + next || type >= 0xF0 || (type == 'W' && next == 1);
  if (is_next) return next;
  return type >= '1' && type <= '7' ? static_cast<std::size_t>(type - '0') : 0;
}

}  // namespace

bool Hdl64SetCollector::take(std::uint8_t type, std::uint8_t value, Hdl64Calibration& calibration) noexcept {
  if (type == last_type_) return false;  // no type follows itself: a packet that comes twice
  last_type_ = type;
  if (kCycle.find(static_cast<char>(type)) != std::string_view::npos) return false;
  const std::size_t place = place_among_seven(type, digit_);
  const bool follows = place == digit_ % kDigits + 1;
  digit_ = place;
  if (!follows) count_ = 0;
  if (count_ == 0 && place != 1) return false;  // a set begins with a cycle
  bytes_[count_++] = value;
  if (!fits(value)) {
    // The byte that does not fit may be the first of a set.
    count_ = 0;
    if (place == 1) bytes_[count_++] = value;
    if (count_ == 1 && !fits(value)) count_ = 0;
    return false;
  }
  if (count_ < kBytes) return false;
  count_ = 0;
  return is_sound(calibration);
}

bool Hdl64SetCollector::fits(std::uint8_t value) const noexcept {
  const std::size_t at = count_ - 1;
  if (at < kMarker.size()) return value == static_cast<std::uint8_t>(kMarker[at]);
  const bool is_laser_number =
      at >= kLaserAt && at < kLaserAt + kHdl64Lasers * kLaserStep && (at - kLaserAt) % kLaserStep == 0;
  return !is_laser_number || value == (at - kLaserAt) / kLaserStep;
}

bool Hdl64SetCollector::is_sound(Hdl64Calibration& calibration) const noexcept {
  const Bytes set(bytes_);
  const std::uint16_t expected =
      checksum_ == Hdl64Checksum::crc16 ? crc16_of_lasers(set) : static_cast<std::uint16_t>(kBytes);
  if (unsigned16(set, kChecksumAt) != expected) return false;
  Hdl64Calibration read;
  for (std::size_t i = 0; i < kHdl64Lasers; ++i) {
    read.lasers[i] = read_laser(laser_bytes(set, i));
    if (!is_plausible(read.lasers[i])) return false;
  }
  read.intensity_is_corrected = set[kPowerAt] == kCorrectedInside;
  calibration = read;
  return true;
}

std::optional<std::int64_t> Hdl64Calendar::take(std::uint8_t type, std::uint8_t value) noexcept {
  if (const auto field = kCalendar.find(static_cast<char>(type)); field != std::string_view::npos) {
    fields_[field] = value;
    known_ |= 1U << field;
    return std::nullopt;
  }
  if (type != 'G') return std::nullopt;
  const bool whole = known_ == (1U << kCalendar.size()) - 1;
  known_ = 0;
  if (!whole || value != kGpsLocked) return std::nullopt;
  const auto now_s = unix_seconds({.year = 2000 + fields_[5],
                                   .month = fields_[4],
                                   .day = fields_[3],
                                   .hour = fields_[0],
                                   .minute = fields_[1],
                                   .second = fields_[2]});
  const auto before_s = std::exchange(before_s_, now_s);
  const bool agree = now_s && before_s && *now_s - *before_s >= 0 && *now_s - *before_s <= 1;
  return agree ? now_s : std::nullopt;
}

}  // namespace landfix::drivers::velodyne
