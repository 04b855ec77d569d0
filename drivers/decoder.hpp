// What every decoder is: it takes one packet, appends its points to the current sweep, and says when a sweep
// is complete. A packet that is not what it should be is refused whole, with the reason, before a point of
// it is used.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/stream_counters.hpp"
#include "drivers/sweep.hpp"

namespace landfix::drivers {

/// A UDP payload, of the sensor's data or telemetry port, and when it was received.
struct Packet {
  std::span<const std::byte> payload;
  std::int64_t receive_utc_ns = 0;  ///< Unix nanoseconds UTC, of the kernel or the capture
};

/// Why a packet was refused, or that it was not.
enum class DecodeStatus : std::uint8_t {
  decoded,
  telemetry,          ///< position, status or calibration: understood, holds no points
  wrong_size,         ///< not the model's payload size
  wrong_header,       ///< a marker, flag, count or unit does not fit the model
  wrong_model,        ///< the packet names another sensor model or unit
  wrong_return_mode,  ///< a return mode that the model does not document
  wrong_azimuth,      ///< 360 deg or more, or more than one turn in a packet
  wrong_time,         ///< not a date or a time, or far from that of its neighbours
  wrong_checksum,     ///< damaged on the way
  uncalibrated,       ///< sound, but the unit's calibration has not come yet
  duplicate,          ///< has come before
  late,               ///< its sweep has been handed over already
};
inline constexpr std::size_t kDecodeStatusCount = 12;

/// Whether a packet that should have given points gave none.
[[nodiscard]] constexpr bool is_rejected(DecodeStatus status) noexcept {
  return status != DecodeStatus::decoded && status != DecodeStatus::telemetry;
}

using StatusCounts = std::array<std::uint64_t, kDecodeStatusCount>;  ///< packets, by DecodeStatus

/// Data packets that gave no points.
[[nodiscard]] std::uint64_t rejected(const StatusCounts& counts) noexcept;

/// One line of meaning, in English.
[[nodiscard]] std::string_view to_string(DecodeStatus status) noexcept;

struct DecodeResult {
  DecodeStatus status = DecodeStatus::decoded;
  bool sweep_completed = false;  ///< `SweepPair::completed` holds a new sweep
};

template <class T>
concept PacketDecoder = requires(T decoder, const Packet& packet, SweepPair& sweeps) {
  { decoder.decode(packet, sweeps) }
  noexcept->std::same_as<DecodeResult>;
  /// Hands over what has been gathered of the last sweep; false if there is nothing.
  { decoder.flush(sweeps) }
  noexcept->std::same_as<bool>;
  { decoder.counters() }
  noexcept->std::same_as<const StreamCounters&>;
};

}  // namespace landfix::drivers
