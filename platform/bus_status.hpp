// How a CAN interface is, told by the thread that uses it to any other.
#pragma once

#include <cstdint>
#include <string_view>

namespace landfix::platform {

enum class BusState : std::uint8_t {
  up,
  error_passive,  ///< the controller sees many errors, but still sends
  bus_off,        ///< the controller has left the bus, until it is restarted
  down,           ///< the interface is not up
  missing,        ///< no such interface, or no socket for it
};
inline constexpr std::size_t kBusStates = 5;
[[nodiscard]] std::string_view to_string(BusState state) noexcept;

/// A moment's view. Every frame that was to be sent is in one of the first three counts.
struct BusStatus {
  BusState state = BusState::missing;
  int error = 0;  ///< errno that made it so; 0: none
  std::uint64_t frames_sent = 0;
  std::uint64_t dropped_queue_full = 0;
  std::uint64_t dropped_bus_down = 0;  ///< the interface off the bus, down or missing
  std::uint64_t times_lost = 0;        ///< the interface was there and went
};

}  // namespace landfix::platform
