// A capture in memory, to be spoilt packet by packet and then read as any other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "platform/packet_source.hpp"
#include "platform/pcap_source.hpp"

namespace landfix::test {

struct OwnedPacket {
  platform::UdpPacket packet;  ///< but for its payload
  std::vector<std::byte> payload;
};
using PacketList = std::vector<OwnedPacket>;

[[nodiscard]] inline PacketList read_packets(const std::string& capture) {
  platform::PcapSource source(capture);
  PacketList packets;
  for (platform::UdpPacket packet; source.next(packet) == platform::ReadStatus::packet;) {
    packets.push_back({packet, {packet.payload.begin(), packet.payload.end()}});
  }
  return packets;
}

/// `packets` must outlive it.
class ListSource final : public platform::PacketSource {
 public:
  explicit ListSource(const PacketList& packets) : packets_(packets) {}

  [[nodiscard]] platform::ReadStatus next(platform::UdpPacket& packet) noexcept override {
    if (next_ == packets_.size()) return platform::ReadStatus::end;
    const OwnedPacket& owned = packets_[next_++];
    packet = owned.packet;
    packet.payload = owned.payload;
    return platform::ReadStatus::packet;
  }

 private:
  const PacketList& packets_;
  std::size_t next_ = 0;
};

}  // namespace landfix::test
