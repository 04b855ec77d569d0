// Membership of a socket in a multicast group.
#pragma once

#include <cstdint>

namespace landfix::platform {

/// Whether the socket is in the group now, whether or not it was. Addresses in host byte order;
/// `interface_address` is one of this computer, 0: the interface that leads there. Errno says why not.
[[nodiscard]] bool join_group(int descriptor, std::uint32_t group, std::uint32_t interface_address) noexcept;

}  // namespace landfix::platform
