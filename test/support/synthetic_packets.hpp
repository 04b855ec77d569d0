// Data packets of a sensor that turns at a given speed, written field by field for tests and benchmarks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/velodyne/wire.hpp"
#include "support/pandar_packets.hpp"
#include "support/store.hpp"

namespace landfix::test {

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

}  // namespace landfix::test
