#include "platform/can_receiver.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <sys/socket.h>
#include <sys/uio.h>

#include "platform/ancillary.hpp"
#include "platform/can_wire.hpp"
#include "platform/utc_clock.hpp"

namespace landfix::platform {
namespace {

[[nodiscard]] std::int64_t to_ns(const timespec& time) noexcept {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// What the kernel says beside a frame.
struct Ancillary {
  std::int64_t stamp_utc_ns = 0;  ///< 0: none
  std::uint32_t overflowed = 0;   ///< frames dropped by this socket until now; 0 also where it is not said
};

[[nodiscard]] Ancillary ancillary_of(msghdr& message) noexcept {
  Ancillary result;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET) continue;
    if (header->cmsg_type == SCM_TIMESTAMPNS) result.stamp_utc_ns = to_ns(value_of<timespec>(*header));
    if (header->cmsg_type == SO_RXQ_OVFL) result.overflowed = value_of<std::uint32_t>(*header);
  }
  return result;
}

}  // namespace

CanReceiver::Ids::Ids(std::span<const CanId> wanted) noexcept : count(std::min(wanted.size(), kMaxIds)) {
  std::copy_n(wanted.begin(), count, ids.begin());
}

CanReceiver::CanReceiver(std::string_view interface, std::span<const CanId> ids,
                         const CanSystem& system) noexcept
    : ids_(ids),
      port_({.interface = CanInterfaceName(interface),
             .use = CanSocketUse::receive,
             .fd = true,
             .ids = ids_.all()},
            system) {}

bool CanReceiver::receive(CanFrame& frame, std::int64_t& stamp_utc_ns) noexcept {
  while (port_.socket() >= 0) {
    canfd_frame wire;
    alignas(cmsghdr) std::array<std::byte, 256> control;
    iovec buffer{.iov_base = &wire, .iov_len = sizeof wire};
    msghdr message{};
    message.msg_iov = &buffer;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = ::recvmsg(port_.socket(), &message, MSG_DONTWAIT);
    if (size < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) return false;
      port_.failed(errno);
      return false;
    }
    const auto received = from_wire(std::as_bytes(std::span(&wire, 1)).first(static_cast<std::size_t>(size)));
    if (size == 0) return false;  // the other end of a test's pair is closed
    const Ancillary ancillary = ancillary_of(message);
    take_overflow(ancillary.overflowed);
    if (!received) continue;
    ++frames_received_;
    port_.worked();
    frame = *received;
    stamp_utc_ns = ancillary.stamp_utc_ns != 0 ? ancillary.stamp_utc_ns : utc_ns();
    return true;
  }
  return false;
}

void CanReceiver::take_overflow(std::uint32_t overflowed) noexcept {
  if (overflowed < last_overflow_) last_overflow_ = 0;
  frames_overflowed_ += overflowed - last_overflow_;
  last_overflow_ = overflowed;
}

}  // namespace landfix::platform
