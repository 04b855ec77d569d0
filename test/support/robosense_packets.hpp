// RoboSense's packets, written field by field for tests and benchmarks; big-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace landfix::test {

inline void store_big(std::byte* at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i)
    at[i] = static_cast<std::byte>(value >> (8 * (bytes - 1 - i)) & 0xFF);
}

/// A data packet: 12 blocks of 32 slots, sound and empty, at 2023-11-14 23:00:01 UTC.
class RobosensePacket {
 public:
  static constexpr std::int64_t kTimeUtcNs = 1'700'002'801'000'000'000;

  /// `model`: rs32, rs16 or helios16p.
  explicit RobosensePacket(std::string_view model = "rs32") : helios_(model == "helios16p") {
    if (helios_) {
      store_big(bytes_.data(), 0x55AA055A, 4);
      bytes_[17] = std::byte{1};  // units of 0.0025 m
    } else {
      store_big(bytes_.data(), 0x55AA050A5AA550A0, 8);
      const std::array<unsigned, 6> date{23, 11, 14, 23, 0, 1};
      for (std::size_t i = 0; i < date.size(); ++i) set_byte(20 + i, date[i]);
    }
    for (std::size_t block = 0; block < 12; ++block) set_flag(block, 0xFFEE);
    store_big(&bytes_[1246], 0x00FF, 2);
    set_time_us(0);
  }

  void set_byte(std::size_t at, unsigned value) { store_big(&bytes_[at], value, 1); }
  void set_flag(std::size_t block, unsigned flag) { store_big(&bytes_[42 + 100 * block], flag, 2); }
  void set_azimuth(std::size_t block, unsigned centideg) {
    store_big(&bytes_[44 + 100 * block], centideg, 2);
  }
  void set_return(std::size_t block, std::size_t slot, unsigned range_raw, unsigned intensity = 0) {
    store_big(&bytes_[46 + 100 * block + 3 * slot], range_raw, 2);
    store_big(&bytes_[48 + 100 * block + 3 * slot], intensity, 1);
  }
  /// Since kTimeUtcNs.
  void set_time_us(std::int64_t microseconds) {
    const auto seconds = static_cast<std::uint64_t>(microseconds / 1'000'000);
    const auto rest = static_cast<std::uint64_t>(microseconds % 1'000'000);
    if (helios_) {
      store_big(&bytes_[20], static_cast<std::uint64_t>(kTimeUtcNs) / 1'000'000'000 + seconds, 6);
      store_big(&bytes_[26], rest, 4);
    } else {
      store_big(&bytes_[25], 1 + seconds, 1);
      store_big(&bytes_[26], rest / 1000, 2);
      store_big(&bytes_[28], rest % 1000, 2);
    }
  }
  /// Azimuths from `first` on, `step` a firing; a firing is `blocks` blocks.
  void set_azimuths(unsigned first_centideg, double step_centideg, std::size_t blocks = 1) {
    for (std::size_t block = 0; block < 12; ++block) {
      const std::size_t firing = block / blocks;
      const double turned = step_centideg * static_cast<double>(firing);
      set_azimuth(block, (first_centideg + static_cast<unsigned>(turned)) % 36000U);
    }
  }

  [[nodiscard]] std::span<std::byte> bytes() { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::array<std::byte, 1248> bytes_{};
  bool helios_;
};

/// A device information packet, 600 rpm, of today's firmware, without angles.
class RobosenseDeviceInfo {
 public:
  RobosenseDeviceInfo() : bytes_(1248) {
    store_big(bytes_.data(), 0xA5FF005A11115555, 8);
    set_rpm(600);
    store_big(&bytes_[40], 0x05'0102'0300, 5);
    store_big(&bytes_[45], 0x08'0309'0000, 5);
    set_return_mode(1);
    store_big(&bytes_[1246], 0x0FF0, 2);
  }

  void set_rpm(unsigned rpm) { store_big(&bytes_[8], rpm, 2); }
  /// The three bytes from 41 on.
  void set_top_firmware(unsigned version) { store_big(&bytes_[41], version, 3); }
  void set_bottom_firmware(unsigned version) { store_big(&bytes_[45], version, 3); }
  void set_return_mode(unsigned mode) { store_big(&bytes_[300], mode, 1); }
  void set_byte(std::size_t at, unsigned value) { store_big(&bytes_[at], value, 1); }
  /// Sign and magnitude of RS-LiDAR-32 and Helios.
  void set_vertical(std::size_t slot, int units) { set_signed(468 + 3 * slot, units); }
  void set_horizontal(std::size_t slot, int units) { set_signed(564 + 3 * slot, units); }
  /// Magnitude of RS-LiDAR-16, 0.0001 deg.
  void set_rs16_vertical(std::size_t slot, unsigned magnitude) {
    store_big(&bytes_[1165 + 3 * slot], magnitude, 3);
  }

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void set_signed(std::size_t at, int units) {
    store_big(&bytes_[at], units < 0 ? 1U : 0U, 1);
    store_big(&bytes_[at + 1], static_cast<unsigned>(units < 0 ? -units : units), 2);
  }
  std::vector<std::byte> bytes_;
};

/// Nominal angles of the RS-LiDAR-32 [0.001 deg], in the order of the slots that most units have.
inline constexpr std::array<std::array<int, 2>, 32> kRs32AnglesMilliDeg{
    {{-10281, 8000}, {-6424, 8000},  {2333, 8000},   {3333, -8000},  {4667, 8000},    {7000, -8000},
     {10333, 8000},  {15000, -8000}, {333, -8000},   {0, -2672},     {-333, 2672},    {-667, 8000},
     {1667, -8000},  {1333, -2672},  {1000, 2672},   {667, 8000},    {-25000, -8000}, {-14638, -8000},
     {-7910, -8000}, {-5407, -8000}, {-3667, -8000}, {-4000, -2672}, {-4333, 2672},   {-4667, 8000},
     {-2333, -8000}, {-2667, -2672}, {-3000, 2672},  {-3333, 8000},  {-1000, -8000},  {-1333, -2672},
     {-1667, 2672},  {-2000, 8000}}};

/// A unit's device information as the model sends it: its nominal angles, single return.
[[nodiscard]] inline RobosenseDeviceInfo robosense_unit(std::string_view model) {
  RobosenseDeviceInfo info;
  if (model == "helios16p") {
    info.set_return_mode(4);
    for (std::size_t i = 0; i < 16; ++i) {
      info.set_vertical(i, 1500 - 200 * static_cast<int>(i));
      info.set_horizontal(i, i % 2 == 0 ? -400 : 360);
    }
  }
  for (unsigned i = 0; i < 16 && model == "rs16"; ++i) {
    info.set_rs16_vertical(i, 10'000 * (15 - 2 * (i % 8)));
  }
  for (std::size_t i = 0; i < 32 && model == "rs32"; ++i) {
    info.set_vertical(i, kRs32AnglesMilliDeg[i][0]);
    info.set_horizontal(i, kRs32AnglesMilliDeg[i][1]);
  }
  return info;
}

}  // namespace landfix::test
