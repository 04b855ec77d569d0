// One value in a frame: where its bits are and what they mean. Little-endian (Intel) fixed point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "platform/pose_report.hpp"

namespace landfix::platform {

struct Bits {
  std::uint16_t start = 0;  ///< of the least significant bit
  std::uint8_t length = 0;  ///< 1 to 64
  bool is_signed = false;

  /// The bits alone, without their place.
  [[nodiscard]] constexpr std::uint64_t mask() const noexcept { return ~std::uint64_t{0} >> (64 - length); }
};

[[nodiscard]] constexpr Bits signed_at(std::uint16_t start, std::uint8_t length) noexcept {
  return {.start = start, .length = length, .is_signed = true};
}
[[nodiscard]] constexpr Bits unsigned_at(std::uint16_t start, std::uint8_t length) noexcept {
  return {.start = start, .length = length, .is_signed = false};
}

/// A number, a code (whose every raw value has a meaning) or a time.
using Field = std::variant<double PoseReport::*, std::uint16_t PoseReport::*, std::int64_t PoseReport::*>;

/// Of a number or a time one raw value says "not available": the lowest if signed, the highest if not.
struct Signal {
  std::string_view name;
  Field field;
  Bits bits{};
  double scale = 1.0;  ///< physical value of one step; of a time: seconds
  std::string_view unit{};
  std::string_view meaning{};
  std::span<const std::string_view> names{};  ///< of a code's values, from 0 on

  [[nodiscard]] constexpr bool is_code() const noexcept {
    return std::holds_alternative<std::uint16_t PoseReport::*>(field);
  }
  /// The smallest and the largest raw value that is one, and the one that is none.
  [[nodiscard]] constexpr std::int64_t lowest() const noexcept {
    return bits.is_signed ? -static_cast<std::int64_t>(bits.mask() >> 1) : 0;
  }
  [[nodiscard]] constexpr std::uint64_t highest() const noexcept {
    if (bits.is_signed) return bits.mask() >> 1;
    return is_code() ? bits.mask() : bits.mask() - 1;
  }
  [[nodiscard]] constexpr std::uint64_t not_available() const noexcept {
    return bits.is_signed ? std::uint64_t{1} << (bits.length - 1) : bits.mask();
  }
};

/// Those of a frame that are there.
[[nodiscard]] std::uint64_t get_bits(std::span<const std::byte> frame, Bits bits) noexcept;
void put_bits(std::span<std::byte> frame, Bits bits, std::uint64_t raw) noexcept;

struct RawValue {
  std::uint64_t raw = 0;   ///< as it lies in the frame
  bool saturated = false;  ///< the value is beyond what the signal can hold
};

/// Rounds half to even and clamps, never wraps.
[[nodiscard]] RawValue encode_signal(const Signal& signal, const PoseReport& report) noexcept;
void decode_signal(const Signal& signal, std::uint64_t raw, PoseReport& report) noexcept;

}  // namespace landfix::platform
