// Where metrics are offered and asked for: "IPV4:PORT" or "unix:/PATH", as [metrics] address says it.
#pragma once

#include <cstdint>
#include <string>

#include "platform/file_descriptor.hpp"

namespace landfix::tools {

/// A socket that listens there and does not block. Takes the place of a Unix socket that nobody serves any
/// more. Throws std::runtime_error with the address and the reason.
[[nodiscard]] platform::FileDescriptor listen_at(const std::string& text);

/// The port that the kernel chose where port 0 was asked for; 0 of a Unix socket.
[[nodiscard]] std::uint16_t port_of(const platform::FileDescriptor& listener);

/// The body of what `path` answers. Throws std::runtime_error that says what to do where nothing does.
[[nodiscard]] std::string http_get(const std::string& address, const std::string& path);

}  // namespace landfix::tools
