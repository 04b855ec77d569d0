// What tells RoboSense's rotating sensors apart, as data: one decoder reads them all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/robosense/wire.hpp"

namespace landfix::drivers::robosense {

enum class TimeForm : std::uint8_t {
  calendar,  ///< year since 2000, month, day, hour, minute, second u8; ms, us u16; UTC
  seconds,   ///< u48 since 1970, us u32
};

enum class AngleForm : std::uint8_t {
  sign_and_u16,  ///< a byte 0 (plus) or 1 (minus), the magnitude; FF where nothing is programmed
  lower_half,    ///< u24, negative for the first half of the slots
};

/// Where the device information holds the angles, in the order of the slots.
struct AngleTable {
  AngleForm form{};
  double unit_deg = 0.0;
  std::size_t vertical_at = 0;
  std::size_t horizontal_at = 0;  ///< 0: it holds none, they are zero
};

struct Description {
  /// 32: a block is one firing, and dual returns come in pairs of blocks. 16: a block is two firings, or one
  /// with its two returns.
  std::size_t lasers = 0;
  std::size_t magic_bytes = 0;
  std::array<std::uint8_t, 8> magic{};  ///< of data packets
  TimeForm time{};
  /// 0: the header says it.
  double range_unit_m = 0.0;
  /// The firmware of 2018 counts ranges in centimetres and marks the group of lasers in bit 15.
  bool had_centimetre_firmware = false;
  double firing_period_us = 0.0;
  std::array<double, kMaxLasers> firing_time_us{};  ///< since the block's azimuth was taken
  double lens_forward_m = 0.0;                      ///< where the beams start, ahead of the axis of rotation
  AngleTable angles;
  /// Ascending elevations, the same for all units but for a fraction of a degree, to know another model's
  /// device information by; empty where there are variants.
  std::span<const double> nominal_elevations_deg{};
  /// Bottom board firmware from which on the return mode of the device information means something; 0:
  /// always.
  std::uint32_t return_mode_since = 0;
};

/// RS-LiDAR-32 User Manual, "Channel number and time". i counts from 1: the manual's integer i / 16 puts
/// lasers 16 and 32 one step late, and so they are.
consteval std::array<double, kMaxLasers> rs32_firing_times_us() {
  std::array<double, kMaxLasers> times_us{};
  for (std::size_t i = 1; i <= kMaxLasers; ++i) {
    const std::size_t half = i / 16;
    times_us[i - 1] = 2.88 * static_cast<double>((i - 1) % 16) + 1.44 * static_cast<double>(half);
  }
  return times_us;
}

consteval std::array<double, kMaxLasers> rs16_firing_times_us() {
  std::array<double, kMaxLasers> times_us{};
  for (std::size_t i = 0; i < 16; ++i) times_us[i] = 2.8 * static_cast<double>(i);
  return times_us;
}

inline constexpr std::array<double, 32> kRs32ElevationsDeg{
    -25.0, -14.638, -10.281, -7.91, -6.424, -5.407, -4.667, -4.333, -4.0,   -3.667, -3.333,
    -3.0,  -2.667,  -2.333,  -2.0,  -1.667, -1.333, -1.0,   -0.667, -0.333, 0.0,    0.333,
    0.667, 1.0,     1.333,   1.667, 2.333,  3.333,  4.667,  7.0,    10.333, 15.0};
inline constexpr std::array<double, 16> kRs16ElevationsDeg{-15.0, -13.0, -11.0, -9.0, -7.0, -5.0, -3.0, -1.0,
                                                           1.0,   3.0,   5.0,   7.0,  9.0,  11.0, 13.0, 15.0};

inline constexpr Description kRs32{
    .lasers = 32,
    .magic_bytes = 8,
    .magic = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0},
    .time = TimeForm::calendar,
    .range_unit_m = 0.005,
    .had_centimetre_firmware = true,
    .firing_period_us = 55.52,
    .firing_time_us = rs32_firing_times_us(),
    .lens_forward_m = 0.03997,
    .angles = {.form = AngleForm::sign_and_u16, .unit_deg = 0.001, .vertical_at = 468, .horizontal_at = 564},
    .nominal_elevations_deg = kRs32ElevationsDeg,
    .return_mode_since = 0x080209};

inline constexpr Description kRs16{
    .lasers = 16,
    .magic_bytes = 8,
    .magic = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0},  // the RS-LiDAR-32's
    .time = TimeForm::calendar,
    .range_unit_m = 0.005,
    .firing_period_us = 55.5,
    .firing_time_us = rs16_firing_times_us(),
    .lens_forward_m = 0.03825,
    .angles = {.form = AngleForm::lower_half, .unit_deg = 0.0001, .vertical_at = 1165},
    .nominal_elevations_deg = kRs16ElevationsDeg,
    .return_mode_since = 0x080209};

/// Firing times: the maker's older driver. Its newer one spaces all lasers by 1.73 us, which is the 32-laser
/// Helios' spacing; recorded clouds follow the older.
inline constexpr Description kHelios16p{
    .lasers = 16,
    .magic_bytes = 4,
    .magic = {0x55, 0xAA, 0x05, 0x5A},
    .time = TimeForm::seconds,
    .firing_period_us = 55.56,
    .firing_time_us = {0.0, 3.15, 6.30, 9.45, 13.26, 17.08, 20.56, 23.71, 26.53, 27.77, 31.49, 32.73, 36.46,
                       38.94, 41.42, 43.91},
    .lens_forward_m = 0.03498,
    .angles = {.form = AngleForm::sign_and_u16, .unit_deg = 0.01, .vertical_at = 468, .horizontal_at = 564}};

/// Not in the catalogue: it tells a recording of it, taken for a Helios-16P, by its geometry.
inline constexpr Description kHelios32{
    .lasers = 32,
    .magic_bytes = 4,
    .magic = {0x55, 0xAA, 0x05, 0x5A},
    .time = TimeForm::seconds,
    .firing_period_us = 55.56,
    .firing_time_us = {0.0,   1.57,  3.15,  4.72,  6.30,  7.87,  9.45,  11.36, 13.26, 15.17, 17.08,
                       18.99, 20.56, 22.14, 23.71, 25.29, 26.53, 29.01, 27.77, 30.25, 31.49, 32.73,
                       33.98, 35.22, 36.46, 37.70, 38.94, 40.18, 41.42, 42.67, 43.91, 45.15},
    .lens_forward_m = 0.03498,
    .angles = {.form = AngleForm::sign_and_u16, .unit_deg = 0.01, .vertical_at = 468, .horizontal_at = 564}};

}  // namespace landfix::drivers::robosense
