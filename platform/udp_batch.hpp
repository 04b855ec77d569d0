// Datagrams from a socket, many with one system call, and what the kernel says of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <netinet/in.h>
#include <sys/socket.h>

namespace landfix::platform {

/// What the kernel says of one datagram.
struct Datagram {
  std::int64_t stamp_utc_ns = 0;     ///< 0 where it has no stamp
  std::uint32_t kernel_drops = 0;    ///< of the socket until this came, running; 0 where it says nothing
  std::uint32_t source_address = 0;  ///< host byte order
  std::uint16_t source_port = 0;
  bool is_broadcast = false;  ///< or multicast; where IP_PKTINFO is asked for
  bool is_truncated = false;
  std::size_t size = 0;  ///< bytes received
};

/// Up to kMost datagrams with one system call. Too large for the stack of a real-time thread.
class UdpBatch {
 public:
  static constexpr std::size_t kMost = 32;

  /// Where the i-th datagram goes.
  void point(std::size_t i, std::span<std::byte> room) noexcept {
    parts_[i] = {.iov_base = room.data(), .iov_len = room.size()};
  }
  /// Never waits. How many came, of at most `count`; negative: errno says why there are none.
  [[nodiscard]] int receive(int descriptor, std::size_t count) noexcept;
  [[nodiscard]] Datagram datagram(std::size_t i) noexcept;

 private:
  static constexpr std::size_t kControl_bytes = 128;  // stamp, drops, destination: 32 + 24 + 32
  struct alignas(cmsghdr) Control {
    std::array<std::byte, kControl_bytes> bytes;
  };

  std::array<mmsghdr, kMost> messages_{};
  std::array<iovec, kMost> parts_{};
  std::array<sockaddr_in, kMost> sources_{};
  std::array<Control, kMost> controls_{};
};

}  // namespace landfix::platform
