// What a pose's time is spent on, from the wire to the bus.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace landfix::platform {

enum class Stage : std::uint8_t {
  kernel_receive,  ///< a packet: from the kernel's time stamp until the receiving thread had it
  ring_wait,       ///< a packet: from there until the solving thread took it up
  decode,          ///< a sweep: on all its packets together
  filter,          ///< likewise
  match,           ///< a sweep
  publish,         ///< a pose: handing its frames to the bus
  last_packet,     ///< a sweep: from its last packet's decoding to its pose
  total,           ///< a sweep: from the arrival of its last packet until its frames were handed to the bus
};
inline constexpr std::array<std::string_view, 8> kStageNames{
    "kernel_receive", "ring_wait", "decode", "filter", "match", "publish", "last_packet", "total"};
inline constexpr std::size_t kStageCount = kStageNames.size();

[[nodiscard]] constexpr std::string_view to_string(Stage stage) noexcept {
  return kStageNames[static_cast<std::size_t>(stage)];
}

}  // namespace landfix::platform
