#include "platform/udp_batch.hpp"

#include <cstring>
#include <ctime>

#include "platform/ancillary.hpp"
#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

void read_control(const cmsghdr& control, Datagram& datagram) noexcept {
  if (control.cmsg_level == SOL_SOCKET && control.cmsg_type == SCM_TIMESTAMPNS) {
    const auto stamp = value_of<timespec>(control);
    datagram.stamp_utc_ns = stamp.tv_sec * kNs_per_s + stamp.tv_nsec;
  } else if (control.cmsg_level == SOL_SOCKET && control.cmsg_type == SO_RXQ_OVFL) {
    datagram.kernel_drops = value_of<std::uint32_t>(control);
  } else if (control.cmsg_level == IPPROTO_IP && control.cmsg_type == IP_PKTINFO) {
    const auto info = value_of<in_pktinfo>(control);
    datagram.is_broadcast = info.ipi_addr.s_addr != info.ipi_spec_dst.s_addr;
  }
}

}  // namespace

int UdpBatch::receive(int descriptor, std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i) {  // all of which the kernel overwrites
    messages_[i].msg_hdr = {.msg_name = &sources_[i],
                            .msg_namelen = sizeof sources_[i],
                            .msg_iov = &parts_[i],
                            .msg_iovlen = 1,
                            .msg_control = controls_[i].bytes.data(),
                            .msg_controllen = kControl_bytes,
                            .msg_flags = 0};
  }
  return ::recvmmsg(descriptor, messages_.data(), static_cast<unsigned>(count), MSG_DONTWAIT, nullptr);
}

Datagram UdpBatch::datagram(std::size_t i) noexcept {
  msghdr& message = messages_[i].msg_hdr;
  Datagram datagram{.source_address = ntohl(sources_[i].sin_addr.s_addr),
                    .source_port = ntohs(sources_[i].sin_port),
                    .is_truncated = (message.msg_flags & MSG_TRUNC) != 0,
                    .size = messages_[i].msg_len};
  for (cmsghdr* control = CMSG_FIRSTHDR(&message); control != nullptr;
       control = CMSG_NXTHDR(&message, control)) {
    read_control(*control, datagram);
  }
  return datagram;
}

}  // namespace landfix::platform
