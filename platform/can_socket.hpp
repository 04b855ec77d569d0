// Sockets of the kernel's CAN, and what it says of their interface. Tests put sockets of another kind in
// their place: what is above sees a descriptor and the numbers of errno.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "platform/file_descriptor.hpp"

namespace landfix::platform {

/// The name of an interface, as the kernel holds it.
class CanInterfaceName {
 public:
  static constexpr std::size_t kMaxLength = 15;  // IFNAMSIZ, less its final zero

  /// What is too long is cut (is_can_interface_name tells).
  explicit CanInterfaceName(std::string_view name) noexcept;
  [[nodiscard]] const char* c_str() const noexcept { return text_.data(); }

 private:
  std::array<char, kMaxLength + 1> text_{};
};

/// A frame's identifier, to be let through to a receiver.
struct CanId {
  std::uint32_t id = 0;
  bool extended = false;  ///< the 29-bit format
};

enum class CanSocketUse : std::uint8_t {
  transmit,  ///< takes frames, receives none
  errors,    ///< receives what the controller tells of the bus
  receive,   ///< receives the frames of `ids`, with the time of their receipt
};

struct CanSocketRequest {
  CanInterfaceName interface;
  CanSocketUse use = CanSocketUse::transmit;
  bool fd = false;               ///< frames of CAN FD too
  std::span<const CanId> ids{};  ///< none: every frame
};

/// Of the interface: administratively up; and connected to a bus that runs, which it is not after bus-off.
struct CanLink {
  int error = 0;  ///< errno, if the interface cannot be asked
  bool is_up = false;
  bool is_running = false;
};

/// What the kernel is asked for; neither function waits or throws.
struct CanSystem {
  /// A bound, non-blocking socket; -errno if it cannot be had.
  int (*open)(const CanSocketRequest& request) noexcept;
  CanLink (*link)(int socket, const CanInterfaceName& interface) noexcept;
};

[[nodiscard]] const CanSystem& linux_can() noexcept;

}  // namespace landfix::platform
