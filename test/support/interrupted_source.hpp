// A capture in which nothing comes for a while.
#pragma once

#include <cstdint>
#include <string>

#include "platform/packet_source.hpp"
#include "platform/pcap_source.hpp"

namespace landfix::test {

/// Seconds count from the first packet.
class InterruptedSource final : public platform::PacketSource {
 public:
  InterruptedSource(const std::string& path, double silent_from_s, double silent_for_s)
      : source_(path), from_ns_(to_ns(silent_from_s)), until_ns_(to_ns(silent_from_s + silent_for_s)) {}

  [[nodiscard]] platform::ReadStatus next(platform::UdpPacket& packet) noexcept override {
    for (;;) {
      const platform::ReadStatus status = source_.next(packet);
      if (status != platform::ReadStatus::packet) return status;
      if (first_utc_ns_ == 0) first_utc_ns_ = packet.receive_utc_ns;
      const std::int64_t since_ns = packet.receive_utc_ns - first_utc_ns_;
      if (since_ns < from_ns_ || since_ns >= until_ns_) return status;
    }
  }

 private:
  [[nodiscard]] static std::int64_t to_ns(double s) { return static_cast<std::int64_t>(s * 1e9); }

  platform::PcapSource source_;
  std::int64_t from_ns_;
  std::int64_t until_ns_;
  std::int64_t first_utc_ns_ = 0;
};

}  // namespace landfix::test
