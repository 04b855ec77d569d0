#include "platform/can_wire.hpp"

#include <algorithm>
#include <cstring>

namespace landfix::platform {

static_assert(kMaxClassicBytes == CAN_MAX_DLEN && kMaxFdBytes == CANFD_MAX_DLEN);
static_assert(offsetof(can_frame, data) == offsetof(canfd_frame, data));
static_assert(offsetof(can_frame, can_dlc) == offsetof(canfd_frame, len));

WireFrame to_wire(const CanFrame& frame) noexcept {
  WireFrame wire{.size = frame.fd ? CANFD_MTU : CAN_MTU};
  wire.frame.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0);
  if (frame.bit_rate_switch) wire.frame.flags = CANFD_BRS;
  const auto payload =
      frame.payload().first(std::min(frame.payload().size(), frame.fd ? kMaxFdBytes : kMaxClassicBytes));
  wire.frame.len = static_cast<std::uint8_t>(payload.size());
  if (!payload.empty()) std::memcpy(wire.frame.data, payload.data(), payload.size());
  return wire;
}

std::optional<CanFrame> from_wire(std::span<const std::byte> bytes) noexcept {
  const bool is_fd = bytes.size() == CANFD_MTU;
  if (!is_fd && bytes.size() != CAN_MTU) return std::nullopt;
  canfd_frame wire{};
  std::memcpy(&wire, bytes.data(), bytes.size());
  if ((wire.can_id & (CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0 || !is_can_length(wire.len, is_fd)) {
    return std::nullopt;
  }
  CanFrame frame{.extended = (wire.can_id & CAN_EFF_FLAG) != 0,
                 .fd = is_fd,
                 .bit_rate_switch = is_fd && (wire.flags & CANFD_BRS) != 0,
                 .length = wire.len};
  frame.id = wire.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  std::memcpy(frame.data.data(), wire.data, wire.len);
  return frame;
}

}  // namespace landfix::platform
