// Reads what a data packet says before a point of it is used.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/robosense/description.hpp"

namespace landfix::drivers::robosense {

/// What a packet says, once it is known to be sound.
struct DataHeader {
  std::array<std::uint16_t, kBlocks> azimuth_centideg{};
  std::int64_t first_firing_ns = 0;  ///< by the sensor's clock
  double range_unit_m = 0.0;
};

/// Whether it begins as the model's data packets do.
[[nodiscard]] bool has_magic_of(const Description& model, std::span<const std::byte> payload) noexcept;

/// `payload` has kPacketBytes. Real packets hold twelve blocks, so a block without its flag refuses the
/// whole.
[[nodiscard]] DecodeStatus read_data_header(const Description& model, std::span<const std::byte> payload,
                                            DataHeader& header) noexcept;

/// Whether neighbouring blocks are the two returns of one firing. Nothing in the packet says so, and what the
/// device information says may be old, but no firing shares its azimuth with the next.
[[nodiscard]] bool come_in_pairs(const std::array<std::uint16_t, kBlocks>& azimuth_centideg) noexcept;

}  // namespace landfix::drivers::robosense
