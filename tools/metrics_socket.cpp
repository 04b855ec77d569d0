#include "tools/metrics_socket.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

namespace landfix::tools {
namespace {

using platform::FileDescriptor;

/// An address as the kernel takes it.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  [[nodiscard]] bool is_unix() const { return storage.ss_family == AF_UNIX; }
  [[nodiscard]] std::string path() const {
    return is_unix() ? reinterpret_cast<const sockaddr_un&>(storage).sun_path : "";
  }
};

[[noreturn]] void fail(const std::string& address, std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", address, what));
}

[[nodiscard]] SocketAddress parse(const std::string& address) {
  constexpr std::string_view kUnix = "unix:";
  SocketAddress parsed;
  if (address.starts_with(kUnix)) {
    sockaddr_un local{};
    const std::string path = address.substr(kUnix.size());
    if (!path.starts_with('/') || path.size() >= sizeof(local.sun_path)) fail(address, "expected unix:/PATH");
    local.sun_family = AF_UNIX;
    std::memcpy(local.sun_path, path.c_str(), path.size() + 1);
    std::memcpy(&parsed.storage, &local, sizeof(local));
    parsed.length = sizeof(local);
    return parsed;
  }
  sockaddr_in remote{};
  const std::size_t colon = address.find(':');
  const std::string host = address.substr(0, colon);
  const char* const end = address.data() + address.size();
  std::uint16_t port = 0;
  const bool has_port = colon != std::string::npos && [&] {
    const auto [rest, error] = std::from_chars(address.data() + colon + 1, end, port);
    return error == std::errc() && rest == end;
  }();
  if (!has_port || ::inet_pton(AF_INET, host.c_str(), &remote.sin_addr) != 1) {
    fail(address, "expected IPV4:PORT such as 127.0.0.1:9464, or unix:/PATH");
  }
  remote.sin_family = AF_INET;
  remote.sin_port = htons(port);
  std::memcpy(&parsed.storage, &remote, sizeof(remote));
  parsed.length = sizeof(remote);
  return parsed;
}

[[nodiscard]] FileDescriptor connect_to(const SocketAddress& address, int flags) {
  FileDescriptor socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | flags, 0));
  constexpr timeval kPatience{.tv_sec = 3, .tv_usec = 0};
  ::setsockopt(socket.number(), SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof(kPatience));
  ::setsockopt(socket.number(), SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof(kPatience));
  if (::connect(socket.number(), address.get(), address.length) != 0) return {};
  return socket;
}

/// What a program that was killed has left behind; one that is served stays, and binding fails.
void remove_stale_socket(const SocketAddress& address) {
  if (!address.is_unix()) return;
  const bool is_served = connect_to(address, SOCK_NONBLOCK).is_open() || errno != ECONNREFUSED;
  if (!is_served) ::unlink(address.path().c_str());
}

}  // namespace

FileDescriptor listen_at(const std::string& text) {
  const SocketAddress address = parse(text);
  remove_stale_socket(address);
  FileDescriptor listener(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  if (!address.is_unix()) ::setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  constexpr int kWaiting = 16;
  if (::bind(listener.number(), address.get(), address.length) != 0 ||
      ::listen(listener.number(), kWaiting) != 0) {
    fail(text, fmt::format("cannot offer metrics there: {}", std::strerror(errno)));
  }
  return listener;
}

std::uint16_t port_of(const FileDescriptor& listener) {
  sockaddr_in address{};
  socklen_t length = sizeof(address);
  ::getsockname(listener.number(), reinterpret_cast<sockaddr*>(&address), &length);
  return address.sin_family == AF_INET ? ntohs(address.sin_port) : std::uint16_t{0};
}

std::string http_get(const std::string& address, const std::string& path) {
  const FileDescriptor socket = connect_to(parse(address), 0);
  if (!socket.is_open()) {
    fail(address,
         fmt::format("no daemon answers ({}); landfixd offers its status where [metrics] address says",
                     std::strerror(errno)));
  }
  const std::string request =
      fmt::format("GET {} HTTP/1.1\r\nHost: landfix\r\nConnection: close\r\n\r\n", path);
  std::string response;
  std::array<char, 16384> part;
  ::ssize_t length = ::send(socket.number(), request.data(), request.size(), MSG_NOSIGNAL);
  while (length > 0 && (length = ::recv(socket.number(), part.data(), part.size(), 0)) > 0) {
    response.append(part.data(), static_cast<std::size_t>(length));
    if (response.size() > (16U << 20)) fail(address, "answers without end: this is no landfixd");
  }
  const std::size_t header = response.find("\r\n\r\n");
  if (length < 0) fail(address, fmt::format("no answer: {}", std::strerror(errno)));
  if (header == std::string::npos || !response.starts_with("HTTP/1.")) fail(address, "answers no HTTP");
  if (response.compare(8, 5, " 200 ") != 0) {
    fail(address, fmt::format("{} is refused: {}", path, response.substr(9, response.find('\r') - 9)));
  }
  return response.substr(header + 4);
}

}  // namespace landfix::tools
