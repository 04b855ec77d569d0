// One frame of classic CAN, and where frames go.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace landfix::platform {

struct CanFrame {
  std::uint32_t id = 0;   ///< 11 bits, or 29 if `extended`
  bool extended = false;  ///< the 29-bit format
  std::uint8_t length = 0;
  std::array<std::byte, 8> data{};

  [[nodiscard]] bool operator==(const CanFrame&) const = default;
};

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
