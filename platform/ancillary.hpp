// What the kernel tells beside a datagram, such as when it came.
#pragma once

#include <cstring>

#include <sys/socket.h>

namespace landfix::platform {

/// The data of one control message; it need not be aligned.
template <class Value>
[[nodiscard]] Value value_of(const cmsghdr& control) noexcept {
  Value value{};
  std::memcpy(&value, CMSG_DATA(&control), sizeof value);
  return value;
}

}  // namespace landfix::platform
