// Data packets of the Pandar family, written field by field for tests and benchmarks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "support/store.hpp"

namespace landfix::test {

/// Sound and empty, dated 2020-06-25 12:02:09 UTC: every field can be set.
class PandarPacket {
 public:
  static constexpr std::int64_t kDateUtcNs = 1'593'086'529'000'000'000;

  void set_byte(std::size_t offset, unsigned value) { store(bytes_.data() + offset, value, 1); }
  void set_azimuth(std::size_t block, unsigned centideg) {
    store(bytes_.data() + azimuth_at(block), centideg, 2);
  }
  void set_return(std::size_t block, std::size_t slot, unsigned range_raw, unsigned intensity = 0) {
    store(bytes_.data() + azimuth_at(block) + 2 + 3 * slot, range_raw, 2);
    store(bytes_.data() + azimuth_at(block) + 4 + 3 * slot, intensity, 1);
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
    for (std::size_t block = 0; block < blocks(); ++block) {
      set_azimuth(block, (first_centideg + step_centideg * static_cast<unsigned>(block / returns)) % 36000U);
    }
  }

  [[nodiscard]] std::size_t lasers() const { return lasers_; }
  [[nodiscard]] std::size_t blocks() const { return (tail_ - header_) / block_bytes(); }
  [[nodiscard]] std::span<std::byte> bytes() { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 protected:
  PandarPacket(std::size_t header, std::size_t marker, std::size_t lasers, std::size_t blocks,
               std::uint8_t mode, std::optional<std::uint32_t> sequence)
      : header_(header),
        marker_(marker),
        lasers_(lasers),
        tail_(header + blocks * block_bytes()),
        bytes_(tail_ + 22 + (sequence ? 4 : 0)) {
    set_rpm(600);
    set_mode(mode);
    set_date({120, 6, 25, 12, 2, 9});
    if (sequence) set_sequence(*sequence);
  }

 private:
  [[nodiscard]] std::size_t block_bytes() const { return marker_ + 2 + 3 * lasers_; }
  [[nodiscard]] std::size_t azimuth_at(std::size_t block) const {
    return header_ + block * block_bytes() + marker_;
  }

  std::size_t header_;
  std::size_t marker_;
  std::size_t lasers_;
  std::size_t tail_;
  std::vector<std::byte> bytes_;
};

/// 6 or 7 blocks of 64 slots, with or without a sequence number.
class Pandar64Packet : public PandarPacket {
 public:
  explicit Pandar64Packet(std::uint8_t mode = 0x37, std::size_t blocks = 6,
                          std::optional<std::uint32_t> sequence = std::nullopt)
      : PandarPacket(8, 0, 64, blocks, mode, sequence) {
    constexpr std::array<unsigned, 8> kHeader{0xEE, 0xFF, 64, 0, 0, 4, 0, 0};
    for (std::size_t i = 0; i < kHeader.size(); ++i) set_byte(i, kHeader[i]);
    set_byte(3, static_cast<unsigned>(blocks));
  }
};

/// 10 blocks of 40 slots, with or without a sequence number.
class Pandar40pPacket : public PandarPacket {
 public:
  explicit Pandar40pPacket(std::uint8_t mode = 0x37, std::optional<std::uint32_t> sequence = std::nullopt)
      : PandarPacket(0, 2, 40, 10, mode, sequence) {
    for (std::size_t block = 0; block < 10; ++block) {
      set_byte(124 * block, 0xFF);
      set_byte(124 * block + 1, 0xEE);
    }
  }
};

}  // namespace landfix::test
