// The inner loop of the search over places: what many nodes of a plan view, side by side, are worth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::ndt {

inline constexpr std::size_t kNodesTogether = 64;
using NodeScores = std::array<std::uint16_t, kNodesTogether>;

/// The sums over `offsets` of the bytes from `first + offset` on. Bytes are at most PlanView::kMostWeight,
/// offsets at most PlanPoints::kMost.
void score_nodes(const std::uint8_t* first, std::span<const std::int32_t> offsets,
                 NodeScores& scores) noexcept;

}  // namespace landfix::ndt
