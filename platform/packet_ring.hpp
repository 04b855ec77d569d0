// The packets between the thread that receives and the one that solves: each is written once, by the kernel,
// into its slot, and decoded from there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/packet_source.hpp"
#include "platform/page_memory.hpp"
#include "platform/spsc_indices.hpp"

namespace landfix::platform {

/// What is known of a packet beside its bytes.
struct PacketHeader {
  std::int64_t receive_utc_ns = 0;   ///< kernel time stamp, or the capture's
  std::int64_t arrived_mono_ns = 0;  ///< the same moment by the monotonic clock
  std::int64_t taken_mono_ns = 0;    ///< when the receiving thread had it
  std::uint32_t source_address = 0;  ///< IPv4, host byte order; 0 for IPv6
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::uint32_t size = 0;  ///< bytes of payload, at most the slot's
};

/// Allocates in its constructor only. One thread produces, one consumes.
class PacketRing {
 public:
  /// `slot_bytes`: the largest payload; `slots` is rounded up to a power of two. Throws std::runtime_error
  /// where the memory cannot be had.
  PacketRing(std::size_t slot_bytes, std::size_t slots);

  [[nodiscard]] std::size_t slot_bytes() const noexcept { return slot_bytes_; }
  [[nodiscard]] std::size_t slots() const noexcept { return indices_.capacity(); }

  // For the producer: the i-th free slot, for i below free_slots(); then how many of them are filled.
  [[nodiscard]] std::size_t free_slots(std::size_t wanted) noexcept { return indices_.writable(wanted); }
  [[nodiscard]] std::span<std::byte> room(std::size_t i) noexcept { return bytes_of(indices_.write_slot(i)); }
  [[nodiscard]] PacketHeader& header_to_fill(std::size_t i) noexcept {
    return headers_[indices_.write_slot(i)];
  }
  void publish(std::size_t count) noexcept { indices_.publish(count); }

  // For the consumer: the i-th oldest packet, for i below waiting(), until it is freed.
  [[nodiscard]] std::size_t waiting(std::size_t wanted) noexcept { return indices_.readable(wanted); }
  [[nodiscard]] const PacketHeader& header(std::size_t i = 0) const noexcept {
    return headers_[indices_.read_slot(i)];
  }
  [[nodiscard]] UdpPacket front(std::size_t i = 0) const noexcept {
    const PacketHeader& known = header(i);
    return {.payload = bytes_of(indices_.read_slot(i)).first(known.size),
            .receive_utc_ns = known.receive_utc_ns,
            .source_address = known.source_address,
            .source_port = known.source_port,
            .destination_port = known.destination_port};
  }
  void free(std::size_t count = 1) noexcept { indices_.free(count); }

 private:
  [[nodiscard]] std::span<std::byte> bytes_of(std::size_t slot) const noexcept {
    return memory_.bytes().subspan(slot * stride_bytes_, slot_bytes_);
  }

  std::size_t slot_bytes_;
  std::size_t stride_bytes_;  ///< whole lines of the cache
  SpscIndices<> indices_;
  PageMemory memory_;
  std::vector<PacketHeader> headers_;
};

}  // namespace landfix::platform
