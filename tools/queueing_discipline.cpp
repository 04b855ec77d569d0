#include "tools/queueing_discipline.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>

#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace landfix::tools {
namespace {

using Answer = std::array<std::byte, 8192>;

/// The kernel's answer to "what is this link?"; its size, 0 where there is none.
std::size_t ask_for_link(unsigned index, Answer& answer) {
  struct {
    nlmsghdr header;
    ifinfomsg link;
  } question{};
  question.header = {.nlmsg_len = sizeof question,
                     .nlmsg_type = RTM_GETLINK,
                     .nlmsg_flags = NLM_F_REQUEST,
                     .nlmsg_seq = 1,
                     .nlmsg_pid = 0};
  question.link.ifi_index = static_cast<int>(index);
  const int socket = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (socket < 0) return 0;
  ssize_t size = ::send(socket, &question, sizeof question, 0);
  if (size > 0) size = ::recv(socket, answer.data(), answer.size(), 0);
  ::close(socket);
  return size < 0 ? 0 : static_cast<std::size_t>(size);
}

std::string text_of(std::span<const std::byte> bytes) {
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  text.resize(std::strlen(text.c_str()));
  return text;
}

}  // namespace

std::optional<std::string> queueing_discipline(const std::string& interface) {
  const unsigned index = ::if_nametoindex(interface.c_str());
  Answer answer{};
  if (index == 0) return std::nullopt;
  std::span<const std::byte> rest = std::span(answer).first(ask_for_link(index, answer));
  constexpr std::size_t kHeaders = sizeof(nlmsghdr) + sizeof(ifinfomsg);
  nlmsghdr header{};
  if (rest.size() < kHeaders) return std::nullopt;
  std::memcpy(&header, rest.data(), sizeof header);
  if (header.nlmsg_type != RTM_NEWLINK) return std::nullopt;
  rest = rest.subspan(kHeaders);
  while (rest.size() >= sizeof(rtattr)) {
    rtattr attribute{};
    std::memcpy(&attribute, rest.data(), sizeof attribute);
    if (attribute.rta_len < sizeof attribute || attribute.rta_len > rest.size()) break;
    if (attribute.rta_type == IFLA_QDISC) {
      return text_of(rest.subspan(sizeof attribute, attribute.rta_len - sizeof attribute));
    }
    constexpr std::size_t kAlignment = RTA_ALIGNTO;
    const std::size_t padded = (attribute.rta_len + kAlignment - 1) / kAlignment * kAlignment;
    rest = rest.subspan(std::min(padded, rest.size()));
  }
  return std::nullopt;
}

}  // namespace landfix::tools
