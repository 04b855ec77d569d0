#include "drivers/slot_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "drivers/widest.hpp"

namespace landfix::drivers {
namespace {

template <class T>
using PerSlot = SlotTable::PerSlot<T>;

// A point is written in two moves: its first four numbers, then time and ring.
constexpr std::size_t kHeadBytes = offsetof(Point, time_s);
struct PointTail {
  std::uint32_t time_bits;
  std::uint32_t ring;
};
static_assert(offsetof(Point, x) == 0 && offsetof(Point, y) == 4 && offsetof(Point, z) == 8);
static_assert(offsetof(Point, intensity) == 12 && kHeadBytes == 16 && offsetof(Point, ring) == 20);
static_assert(sizeof(PointTail) == sizeof(Point) - kHeadBytes);
static_assert(std::endian::native == std::endian::little);

/// Range in the low 16 bits, intensity in the next 8.
using Words = PerSlot<std::uint32_t>;

[[nodiscard]] constexpr std::uint32_t range_of(std::uint32_t word) noexcept { return word & 0xFFFFU; }

[[gnu::always_inline]] inline void unpack(const std::byte* bytes, std::size_t count, ByteOrder order,
                                          Words& words) noexcept {
  if (count == 0) return;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::memcpy(&words[i], bytes + kSlotBytes * i, sizeof(std::uint32_t));
  }
  // A word is a byte longer than a slot: the last one would reach beyond the block.
  words[count - 1] = 0;
  std::memcpy(&words[count - 1], bytes + kSlotBytes * (count - 1), kSlotBytes);
  if (order == ByteOrder::little) return;
  for (std::size_t i = 0; i < count; ++i) {
    words[i] = (words[i] & 0xFF0000U) | (words[i] & 0xFFU) << 8U | (words[i] >> 8U & 0xFFU);
  }
}

/// Four points at a time: what is computed beam by beam is stored point by point.
constexpr std::size_t kGroup = 4;
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

[[gnu::always_inline]] inline Four four_of(const PerSlot<float>& values, std::size_t first) noexcept {
  Four four;
  std::memcpy(&four, &values[first], sizeof(four));
  return four;
}

}  // namespace

LANDFIX_WIDEST SlotPoints project_slots(const SlotTable& table, const SlotBlock& block, RawBounds bounds,
                                        std::span<Point> points) noexcept {
  const std::size_t count = table.count;
  alignas(64) Words words;
  unpack(block.slots, count, table.byte_order, words);
  if (block.duplicates != nullptr) {
    alignas(64) Words others;
    unpack(block.duplicates, count, table.byte_order, others);
    for (std::size_t i = 0; i < count; ++i) {
      words[i] = range_of(words[i]) == range_of(others[i]) ? 0 : words[i];
    }
  }

  alignas(64) PerSlot<float> x;
  alignas(64) PerSlot<float> y;
  alignas(64) PerSlot<float> z;
  alignas(64) PerSlot<float> intensity;
  for (std::size_t i = 0; i < count; ++i) {
    const float range_m = static_cast<float>(static_cast<std::int32_t>(range_of(words[i]))) * block.unit_m;
    const float along_m = std::sqrt(std::max(range_m * range_m + table.square_m2[i], 0.0F)) - table.lead_m[i];
    const float rotor_x = table.origin_x_m[i] + along_m * table.direction_x[i];
    const float rotor_y = table.origin_y_m[i] + along_m * table.direction_y[i];
    x[i] = rotor_x * block.cosine + rotor_y * block.sine;
    y[i] = rotor_y * block.cosine - rotor_x * block.sine;
    z[i] = table.origin_z_m[i] + along_m * table.direction_z[i];
    intensity[i] = static_cast<float>(static_cast<std::int32_t>(words[i] >> 16U & 0xFFU));
  }

  for (std::size_t i = count; i % kGroup != 0; ++i) x[i] = y[i] = z[i] = intensity[i] = 0.0F;

  alignas(64) PerSlot<PointTail> tails;
  alignas(64) PerSlot<std::uint32_t> step;  // from this point to the next, 0 where this one is not kept
  std::int32_t latest_bits = 0;             // of times that are not negative: in their order
  for (std::size_t i = 0; i < count; ++i) {
    const auto time_bits = std::bit_cast<std::uint32_t>(block.time_s + table.time_s[i]);
    const std::uint32_t range_raw = range_of(words[i]);
    const bool kept = range_raw >= bounds.least && range_raw <= bounds.most;
    step[i] = kept ? std::uint32_t{sizeof(Point)} : 0U;
    latest_bits = std::max(latest_bits, kept ? static_cast<std::int32_t>(time_bits) : 0);
    tails[i] = {.time_bits = time_bits, .ring = table.ring[i]};
  }

  // Every point is written, and only those that are kept are stepped over: no branch to be guessed.
  auto* const start = reinterpret_cast<std::byte*>(points.data());
  std::byte* next = start;
  for (std::size_t i = 0; i < count; i += kGroup) {
    const auto heads = transposed(four_of(x, i), four_of(y, i), four_of(z, i), four_of(intensity, i));
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
