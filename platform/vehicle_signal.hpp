// One value in a frame of the vehicle's bus: where its bits are, in either byte order, and what they mean.
// What the vehicles of the road send differs in everything, so all of it is data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "platform/can_frame.hpp"

namespace landfix::platform {

/// Bits as a DBC file counts them: bit 8 b + i is bit i of byte b, 0 the least significant.
struct RawField {
  std::uint16_t start = 0;  ///< the least significant bit, of `motorola` the most significant
  std::uint8_t length = 1;  ///< 1 to 64
  bool motorola = false;    ///< big-endian: goes on from bit 0 of a byte to bit 7 of the next
  bool is_signed = false;   ///< two's complement
};

/// Bytes that a frame must have to hold it.
[[nodiscard]] std::size_t bytes_of(RawField field) noexcept;
/// The bits alone, 0 where the frame has none.
[[nodiscard]] std::uint64_t read_raw(std::span<const std::byte> payload, RawField field) noexcept;

enum class VehicleRole : std::uint8_t {
  speed,
  wheel_fl,
  wheel_fr,
  wheel_rl,
  wheel_rr,
  yaw_rate,
  reverse,
  latitude,
  longitude,
  altitude,
  heading,
};
inline constexpr std::array<std::string_view, 11> kVehicleRoleNames{
    "speed",   "wheel_fl", "wheel_fr",  "wheel_rl", "wheel_rr", "yaw_rate",
    "reverse", "latitude", "longitude", "altitude", "heading"};

struct VehicleSignal {
  VehicleRole role{};
  std::uint32_t id = 0;
  bool extended = false;
  RawField field{};
  double scale = 1.0;                        ///< of a raw step, in SI units: m, m/s, rad, rad/s
  double offset = 0.0;                       ///< added then, in SI units
  std::optional<std::uint16_t> sign_bit{};   ///< set: the value is negative
  std::optional<std::uint16_t> valid_bit{};  ///< what it says depends on `valid_value`
  bool valid_value = true;
  std::array<std::uint64_t, 4> invalid_raw{};  ///< raw values that are none
  std::size_t invalid_count = 0;
  double low = 0.0;  ///< what is beyond these is no value
  double high = 0.0;
  std::int64_t timeout_ns = 0;  ///< a value counts as long as this

  [[nodiscard]] bool is_in(const CanFrame& frame) const noexcept {
    return frame.id == id && frame.extended == extended;
  }
};

/// In SI units; nothing where the frame is too short, the signal says that it is not valid, or its value is
/// beyond its limits. The signal must be in the frame.
[[nodiscard]] std::optional<double> value_of(const VehicleSignal& signal, const CanFrame& frame) noexcept;

/// Those that one part of the program listens to.
struct VehicleSignals {
  static constexpr std::size_t kMax = 16;

  std::array<VehicleSignal, kMax> signals{};
  std::size_t count = 0;

  [[nodiscard]] std::span<const VehicleSignal> all() const& noexcept {
    return std::span(signals).first(count);
  }
  /// The signals would be gone.
  std::span<const VehicleSignal> all() const&& = delete;
  [[nodiscard]] bool has(VehicleRole role) const noexcept;
};

/// The newest value of a signal, and how long it counts.
class LatestValue {
 public:
  void set(double value, std::int64_t stamp_utc_ns, std::int64_t timeout_ns) noexcept {
    value_ = value;
    stamp_utc_ns_ = stamp_utc_ns;
    timeout_ns_ = timeout_ns;
  }
  /// Nothing if it was never told, or too long ago.
  [[nodiscard]] std::optional<double> at(std::int64_t stamp_utc_ns) const noexcept;

 private:
  double value_ = 0.0;
  std::int64_t stamp_utc_ns_ = 0;
  std::int64_t timeout_ns_ = -1;
};

}  // namespace landfix::platform
