// What the inner loops of all projectors begin and end with: the slots of a block become columns of numbers,
// one a field, which a compiler computes several lanes at a time; and the columns become points. Always
// inline: they are compiled for the instruction set of the loop that they are part of.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "drivers/point.hpp"

namespace landfix::drivers {

inline constexpr std::size_t kSlotBytes = 3;

/// Of the ranges on the wire.
enum class ByteOrder : std::uint8_t { little, big };

struct SlotPoints {
  std::size_t count = 0;
  float latest_s = 0.0F;  ///< 0 if there are none
};

/// A block of at most `Capacity` slots, a multiple of four.
template <std::size_t Capacity>
struct SlotColumns {
  template <class T>
  using Column = std::array<T, Capacity>;

  alignas(64) Column<std::uint32_t> words;  ///< range in the low 16 bits, intensity in the next 8
  alignas(64) Column<float> x;
  alignas(64) Column<float> y;
  alignas(64) Column<float> z;
  alignas(64) Column<float> intensity;
  alignas(64) Column<std::uint32_t> kept;  ///< 1 or 0
};

[[nodiscard]] constexpr std::uint32_t range_of(std::uint32_t word) noexcept { return word & 0xFFFFU; }
[[nodiscard]] constexpr float intensity_of(std::uint32_t word) noexcept {
  return static_cast<float>(static_cast<std::int32_t>(word >> 16U & 0xFFU));
}

namespace detail {

/// What is computed slot by slot is loaded and stored four slots at a time.
inline constexpr std::size_t kGroup = 4;
using Bytes [[gnu::vector_size(16)]] = unsigned char;

/// Four slots, 12 bytes and four more, to four words.
[[gnu::always_inline]] inline Bytes words_of(Bytes slots, ByteOrder order) noexcept {
  constexpr Bytes kZero{};
  return order == ByteOrder::little
             ? __builtin_shufflevector(slots, kZero, 0, 1, 2, 16, 3, 4, 5, 16, 6, 7, 8, 16, 9, 10, 11, 16)
             : __builtin_shufflevector(slots, kZero, 1, 0, 2, 16, 4, 3, 5, 16, 7, 6, 8, 16, 10, 9, 11, 16);
}

}  // namespace detail

/// `words` has room for `count`, rounded up to a multiple of four.
[[gnu::always_inline]] inline void unpack_slots(const std::byte* slots, std::size_t count, ByteOrder order,
                                                std::uint32_t* words) noexcept {
  using detail::Bytes, detail::kGroup;
  for (std::size_t i = 0; i < count; i += kGroup) {
    Bytes bytes{};
    const std::byte* const first = slots + kSlotBytes * i;
    // A load is four bytes longer than four slots: the last ones would reach beyond the block.
    if (const std::size_t left = count - i; left >= kGroup + 2) {
      std::memcpy(&bytes, first, sizeof(bytes));
    } else if (left >= kGroup) {
      std::memcpy(&bytes, first, kSlotBytes * kGroup);
    } else {
      std::memcpy(&bytes, first, kSlotBytes * left);
    }
    const Bytes four = detail::words_of(bytes, order);
    std::memcpy(words + i, &four, sizeof(four));
  }
}

/// Fills `words`. Those whose range is that of their duplicate become 0; `duplicates` may be null.
template <std::size_t Capacity>
[[gnu::always_inline]] inline void read_slots(const std::byte* slots, const std::byte* duplicates,
                                              std::size_t count, ByteOrder order,
                                              SlotColumns<Capacity>& columns) noexcept {
  auto& words = columns.words;
  unpack_slots(slots, count, order, words.data());
  if (duplicates == nullptr) return;
  alignas(64) std::array<std::uint32_t, Capacity> others;
  unpack_slots(duplicates, count, order, others.data());
  for (std::size_t i = 0; i < count; ++i) {
    words[i] = range_of(words[i]) == range_of(others[i]) ? 0 : words[i];
  }
}

namespace detail {

// A point is written in two moves: its first four numbers, then time and ring.
inline constexpr std::size_t kHeadBytes = offsetof(Point, time_s);
struct PointTail {
  std::uint32_t time_bits;
  std::uint32_t ring;
};
static_assert(offsetof(Point, x) == 0 && offsetof(Point, y) == 4 && offsetof(Point, z) == 8);
static_assert(offsetof(Point, intensity) == 12 && kHeadBytes == 16 && offsetof(Point, ring) == 20);
static_assert(sizeof(PointTail) == sizeof(Point) - kHeadBytes);
static_assert(std::endian::native == std::endian::little);

using Four [[gnu::vector_size(16)]] = float;

[[gnu::always_inline]] inline std::array<Four, kGroup> transposed(Four x, Four y, Four z, Four w) noexcept {
  const Four xy_low = __builtin_shufflevector(x, y, 0, 4, 1, 5);
  const Four zw_low = __builtin_shufflevector(z, w, 0, 4, 1, 5);
  const Four xy_high = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const Four zw_high = __builtin_shufflevector(z, w, 2, 6, 3, 7);
  return {__builtin_shufflevector(xy_low, zw_low, 0, 1, 4, 5),
          __builtin_shufflevector(xy_low, zw_low, 2, 3, 6, 7),
          __builtin_shufflevector(xy_high, zw_high, 0, 1, 4, 5),
          __builtin_shufflevector(xy_high, zw_high, 2, 3, 6, 7)};
}

[[gnu::always_inline]] inline Four four_at(const float* values) noexcept {
  Four four;
  std::memcpy(&four, values, sizeof(four));
  return four;
}

}  // namespace detail

/// Writes the points that are kept, in the order of their slots. `start_s` is the block's time, `time_s`
/// those of its slots since then, none negative. `points` has room for `count`, whose rest is overwritten
/// too; bytes between the fields are zero.
template <std::size_t Capacity>
[[gnu::always_inline]] inline SlotPoints write_points(SlotColumns<Capacity>& columns, std::size_t count,
                                                      float start_s, const float* time_s,
                                                      const std::uint32_t* ring,
                                                      std::span<Point> points) noexcept {
  using detail::kGroup, detail::kHeadBytes, detail::PointTail, detail::four_at;
  auto& [words, x, y, z, intensity, kept] = columns;
  for (std::size_t i = count; i % kGroup != 0; ++i) x[i] = y[i] = z[i] = intensity[i] = 0.0F;

  alignas(64) std::array<PointTail, Capacity> tails;
  alignas(64) std::array<std::uint32_t, Capacity> step;  // to the next point, 0 from one that is not kept
  std::int32_t latest_bits = 0;                          // of times that are not negative: in their order
  for (std::size_t i = 0; i < count; ++i) {
    const auto time_bits = std::bit_cast<std::uint32_t>(start_s + time_s[i]);
    step[i] = kept[i] * std::uint32_t{sizeof(Point)};
    latest_bits = std::max(latest_bits, kept[i] != 0 ? static_cast<std::int32_t>(time_bits) : 0);
    tails[i] = {.time_bits = time_bits, .ring = ring[i]};
  }

  // Every point is written, and only those that are kept are stepped over: no branch to be guessed.
  auto* const start = reinterpret_cast<std::byte*>(points.data());
  std::byte* next = start;
  for (std::size_t i = 0; i < count; i += kGroup) {
    const auto heads =
        detail::transposed(four_at(&x[i]), four_at(&y[i]), four_at(&z[i]), four_at(&intensity[i]));
    for (std::size_t k = 0; k < kGroup && i + k < count; ++k) {
      std::memcpy(next, &heads[k], kHeadBytes);
      std::memcpy(next + kHeadBytes, &tails[i + k], sizeof(PointTail));
      next += step[i + k];
    }
  }
  return {.count = static_cast<std::size_t>(next - start) / sizeof(Point),
          .latest_s = std::bit_cast<float>(latest_bits)};
}

}  // namespace landfix::drivers
