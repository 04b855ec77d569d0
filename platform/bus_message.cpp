#include "platform/bus_message.hpp"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

namespace landfix::platform {
namespace {

std::string why_missing(std::string_view interface, int error) {
  switch (error) {
    case EAFNOSUPPORT:
      return "this kernel has no CAN; modprobe can_raw";
    case ENODEV:
    case ENXIO:
      return fmt::format("no such interface; `ip link` lists them; a virtual one: ip link add {} type vcan",
                         interface);
    case EMSGSIZE:
      return fmt::format(
          "it takes frames of classic CAN alone; with it down: ip link set {} type can fd on, or of a "
          "virtual "
          "one: ip link set {} mtu 72",
          interface, interface);
    default:
      return fmt::format("no socket for it: {}", std::generic_category().message(error));
  }
}

}  // namespace

std::string describe_bus(std::string_view interface, BusState state, int error) {
  switch (state) {
    case BusState::up:
      return fmt::format("{}: up", interface);
    case BusState::error_passive:
      return fmt::format("{}: error-passive; look at the wiring, the bit rate and the other nodes",
                         interface);
    case BusState::bus_off:
      return fmt::format(
          "{}: off the bus; ip link set {} type can restart-ms 100 makes it come back by itself", interface,
          interface);
    case BusState::down:
      return fmt::format("{}: down; ip link set {} up", interface, interface);
    case BusState::missing:
      break;
  }
  return fmt::format("{}: {}", interface, why_missing(interface, error));
}

}  // namespace landfix::platform
