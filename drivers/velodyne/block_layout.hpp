// What tells the sensors apart that the BlockDecoder reads (VLP-16 User Manual 63-9243 Rev D, chapter 9,
// VLP-32C User Manual 63-9325 Rev B, and the HDL-32E's).
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {

/// How a model fills its blocks.
struct BlockLayout {
  std::uint8_t product = 0;      ///< the byte that names the model
  std::size_t lasers = 0;        ///< 16, two sequences a block, or 32
  std::int64_t sequence_ns = 0;  ///< from one firing sequence to the next
  double range_unit_m = 0.0;
  bool may_be_unnamed = false;  ///< early firmware leaves mode and product zero

  [[nodiscard]] constexpr double sequence_us() const noexcept {
    return static_cast<double>(sequence_ns) * 1e-3;
  }
  [[nodiscard]] constexpr std::int64_t block_ns() const noexcept {
    return sequence_ns * static_cast<std::int64_t>(kBlockSlots / lasers);
  }
};

inline constexpr BlockLayout kVlp16{
    .product = 0x22, .lasers = 16, .sequence_ns = 55'296, .range_unit_m = 0.002, .may_be_unnamed = true};
inline constexpr BlockLayout kVlp16HiRes{
    .product = 0x24, .lasers = 16, .sequence_ns = 55'296, .range_unit_m = 0.002, .may_be_unnamed = true};
inline constexpr BlockLayout kVlp32c{
    .product = 0x28, .lasers = 32, .sequence_ns = 55'296, .range_unit_m = 0.004};
inline constexpr BlockLayout kHdl32e{
    .product = 0x21, .lasers = 32, .sequence_ns = 46'080, .range_unit_m = 0.002, .may_be_unnamed = true};

}  // namespace landfix::drivers::velodyne
