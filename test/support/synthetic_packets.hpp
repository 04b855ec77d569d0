// Data packets of a sensor that turns at a given speed, written field by field for tests and benchmarks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "drivers/hesai/wire.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::test {

inline void store(std::byte* at, std::uint64_t value, std::size_t bytes) { std::memcpy(at, &value, bytes); }

/// 12 blocks of 32 slots, sound and empty: every field can be set.
class VelodynePacket {
 public:
  explicit VelodynePacket(std::uint8_t product = 0x22, std::uint8_t mode = 0x37) {
    for (std::size_t block = 0; block < drivers::velodyne::kBlocks; ++block) set_flag(block, 0xEEFF);
    set_mode(mode);
    set_product(product);
  }

  void set_flag(std::size_t block, std::uint16_t flag) { store(bytes_.data() + 100 * block, flag, 2); }
  void set_azimuth(std::size_t block, unsigned centideg) {
    store(bytes_.data() + 100 * block + 2, centideg, 2);
  }
  void set_return(std::size_t block, std::size_t slot, unsigned range_raw, unsigned intensity = 0) {
    store(bytes_.data() + 100 * block + 4 + 3 * slot, range_raw, 2);
    store(bytes_.data() + 100 * block + 6 + 3 * slot, intensity, 1);
  }
  void set_time_us(std::uint32_t microseconds) { store(bytes_.data() + 1200, microseconds, 4); }
  void set_mode(std::uint8_t mode) { store(bytes_.data() + 1204, mode, 1); }
  void set_product(std::uint8_t product) { store(bytes_.data() + 1205, product, 1); }
  /// Azimuths from `first` on, `step` a firing; a firing is two blocks in dual mode.
  void set_azimuths(unsigned first_centideg, unsigned step_centideg, std::size_t returns = 1) {
    for (std::size_t block = 0; block < drivers::velodyne::kBlocks; ++block) {
      set_azimuth(block, (first_centideg + step_centideg * static_cast<unsigned>(block / returns)) % 36000U);
    }
  }

  [[nodiscard]] std::span<std::byte> bytes() { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::array<std::byte, sizeof(drivers::velodyne::WirePacket)> bytes_{};
};

/// 6 or 7 blocks of 64 slots, with or without a sequence number, dated 2020-06-25 12:02:09 UTC.
class Pandar64Packet {
 public:
  static constexpr std::int64_t kDateUtcNs = 1'593'086'529'000'000'000;

  explicit Pandar64Packet(std::uint8_t mode = 0x37, std::size_t blocks = 6,
                          std::optional<std::uint32_t> sequence = std::nullopt)
      : tail_(8 + 194 * blocks), bytes_(drivers::hesai::packet_bytes(blocks) + (sequence ? 4 : 0)) {
    constexpr std::array<unsigned, 8> kHeader{0xEE, 0xFF, 64, 0, 0, 4, 0, 0};
    for (std::size_t i = 0; i < kHeader.size(); ++i) store(bytes_.data() + i, kHeader[i], 1);
    store(bytes_.data() + 3, blocks, 1);
    set_rpm(600);
    set_mode(mode);
    set_date({120, 6, 25, 12, 2, 9});
    if (sequence) set_sequence(*sequence);
  }

  void set_byte(std::size_t offset, unsigned value) { store(bytes_.data() + offset, value, 1); }
  void set_azimuth(std::size_t block, unsigned centideg) {
    store(bytes_.data() + 8 + 194 * block, centideg, 2);
  }
  void set_return(std::size_t block, std::size_t slot, unsigned range_raw, unsigned intensity = 0) {
    store(bytes_.data() + 10 + 194 * block + 3 * slot, range_raw, 2);
    store(bytes_.data() + 12 + 194 * block + 3 * slot, intensity, 1);
  }
  void set_rpm(unsigned rpm) { store(bytes_.data() + tail_ + 8, rpm, 2); }
  void set_microseconds(std::uint32_t value) { store(bytes_.data() + tail_ + 10, value, 4); }
  void set_mode(std::uint8_t mode) { store(bytes_.data() + tail_ + 14, mode, 1); }
  /// Year, month, day, hour, minute, second as the packet holds them.
  void set_date(const std::array<unsigned, 6>& date) {
    for (std::size_t i = 0; i < date.size(); ++i) store(bytes_.data() + tail_ + 16 + i, date[i], 1);
  }
  void set_sequence(std::uint32_t sequence) { store(bytes_.data() + tail_ + 22, sequence, 4); }
  void set_azimuths(unsigned first_centideg, unsigned step_centideg, std::size_t returns = 1) {
    for (std::size_t block = 0; 8 + 194 * block < tail_; ++block) {
      set_azimuth(block, (first_centideg + step_centideg * static_cast<unsigned>(block / returns)) % 36000U);
    }
  }

  [[nodiscard]] std::span<std::byte> bytes() { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::size_t tail_;
  std::vector<std::byte> bytes_;
};

}  // namespace landfix::test
