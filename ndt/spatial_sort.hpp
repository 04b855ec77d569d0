// Cells in the order of a space-filling curve: what is near in memory is near in space.
#pragma once

#include <cstdint>
#include <span>

namespace landfix::ndt {

struct SpatialKey {
  std::uint64_t code = 0;   ///< of Morton, and below it whatever tells equal ones apart
  std::uint32_t index = 0;  ///< of what is sorted
};

/// The bits of three indices interleaved, i highest. Of each the lowest 21 bits count.
[[nodiscard]] std::uint64_t morton_code(std::uint64_t i, std::uint64_t j, std::uint64_t k) noexcept;

/// Sorts by code; equal codes keep their order. `scratch`: as large as `keys`. Time is linear in both sizes:
/// one pass for each 11 bits in which the codes differ.
void sort_by_code(std::span<SpatialKey> keys, std::span<SpatialKey> scratch) noexcept;

}  // namespace landfix::ndt
