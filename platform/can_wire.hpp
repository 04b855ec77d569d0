// Frames as the kernel's CAN sockets take and give them: struct can_frame and struct canfd_frame.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <linux/can.h>

#include "platform/can_frame.hpp"

namespace landfix::platform {

/// Both structs begin alike, so the larger holds either; `size` tells the kernel which it is.
struct WireFrame {
  canfd_frame frame{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
    return std::as_bytes(std::span(&frame, 1)).first(size);
  }
};

[[nodiscard]] WireFrame to_wire(const CanFrame& frame) noexcept;

/// Nothing for remote and error frames, and for what has not the size of a frame.
[[nodiscard]] std::optional<CanFrame> from_wire(std::span<const std::byte> bytes) noexcept;

}  // namespace landfix::platform
