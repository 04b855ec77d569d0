#include "platform/source_filter.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <linux/filter.h>
#include <sys/socket.h>

namespace landfix::platform {
namespace {

constexpr std::uint32_t kAll = 0xFFFFFFFF;  // bytes of a datagram that a filter keeps
constexpr std::uint32_t kNone = 0;

/// A program that returns `if_equal` for datagrams from `address`, else `otherwise`.
void attach(int descriptor, int option, std::uint32_t address, std::uint32_t if_equal,
            std::uint32_t otherwise) {
  // Where the network layer's header begins, and in it the source's address.
  constexpr auto kSource = static_cast<std::uint32_t>(SKF_NET_OFF + 12);
  std::array<sock_filter, 4> code{{
      {.code = BPF_LD | BPF_W | BPF_ABS, .jt = 0, .jf = 0, .k = kSource},
      {.code = BPF_JMP | BPF_JEQ | BPF_K, .jt = 0, .jf = 1, .k = address},
      {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = if_equal},
      {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = otherwise},
  }};
  const sock_fprog program{.len = code.size(), .filter = code.data()};
  if (::setsockopt(descriptor, SOL_SOCKET, option, &program, sizeof program) == 0) return;
  throw std::runtime_error(
      fmt::format("the kernel refuses to filter packets by their source: {}; leave [sensor] address empty",
                  std::strerror(errno)));
}

}  // namespace

void keep_only(int descriptor, std::uint32_t source_address) {
  attach(descriptor, SO_ATTACH_FILTER, source_address, kAll, kNone);
}

void keep_all_but(int descriptor, std::uint32_t source_address) {
  attach(descriptor, SO_ATTACH_FILTER, source_address, kNone, kAll);
}

void divide_by_source(int descriptor, std::uint32_t source_address) {
  attach(descriptor, SO_ATTACH_REUSEPORT_CBPF, source_address, 1, 0);
}

}  // namespace landfix::platform
