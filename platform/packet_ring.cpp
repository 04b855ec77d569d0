#include "platform/packet_ring.hpp"

#include <bit>

namespace landfix::platform {
namespace {

constexpr std::size_t kCacheLine_bytes = 64;

}  // namespace

PacketRing::PacketRing(std::size_t slot_bytes, std::size_t slots)
    : slot_bytes_(slot_bytes),
      stride_bytes_((slot_bytes + kCacheLine_bytes - 1) / kCacheLine_bytes * kCacheLine_bytes),
      indices_(std::bit_ceil(slots)),
      memory_(stride_bytes_ * indices_.capacity()),
      headers_(indices_.capacity()) {}

}  // namespace landfix::platform
