// One frame of classic CAN or CAN FD, and where frames go.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::platform {

inline constexpr std::size_t kMaxClassicBytes = 8;
inline constexpr std::size_t kMaxFdBytes = 64;

struct CanFrame {
  std::uint32_t id = 0;          ///< 11 bits, or 29 if `extended`
  bool extended = false;         ///< the 29-bit format
  bool fd = false;               ///< CAN FD: up to 64 bytes
  bool bit_rate_switch = false;  ///< its data at the faster bit rate; CAN FD alone
  std::uint8_t length = 0;       ///< bytes; above 8 not every length exists (is_can_length)
  std::array<std::byte, kMaxFdBytes> data{};

  [[nodiscard]] std::span<const std::byte> payload() const noexcept {
    return std::span(data).first(std::min<std::size_t>(length, data.size()));
  }
  [[nodiscard]] bool operator==(const CanFrame&) const = default;
};

struct StampedFrame {
  std::int64_t stamp_utc_ns = 0;  ///< when it was received
  CanFrame frame{};
};

/// Whether a frame can have this many bytes (ISO 11898-1: beyond 8 the length code takes steps).
[[nodiscard]] constexpr bool is_can_length(std::size_t bytes, bool fd) noexcept {
  if (bytes <= kMaxClassicBytes) return true;
  constexpr std::array<std::size_t, 7> kLongLengths{12, 16, 20, 24, 32, 48, 64};
  return fd && std::find(kLongLengths.begin(), kLongLengths.end(), bytes) != kLongLengths.end();
}

/// The seam between the poses and the bus: an interface of the kernel, a log, a test.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// Never waits; false if the frame could not be taken. `stamp_utc_ns`: when it is sent.
  [[nodiscard]] virtual bool send(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept = 0;
};

}  // namespace landfix::platform
