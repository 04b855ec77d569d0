// One interface over everything that delivers UDP packets, so that a replay runs the code of the vehicle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::platform {

/// One UDP datagram. `payload` is valid until the next call of `PacketSource::next`.
struct UdpPacket {
  std::span<const std::byte> payload;
  std::int64_t receive_utc_ns = 0;   ///< Unix nanoseconds UTC: kernel time stamp, or the capture's
  std::uint32_t source_address = 0;  ///< IPv4, host byte order; 0 for IPv6
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
};

enum class ReadStatus : std::uint8_t {
  packet,     ///< one was delivered
  end,        ///< there will be no more
  truncated,  ///< the capture ends in the middle of a record: like `end`, but data is missing
};

/// The one virtual seam of the data path, at packet granularity.
class PacketSource {
 public:
  PacketSource() = default;
  PacketSource(const PacketSource&) = delete;
  PacketSource& operator=(const PacketSource&) = delete;
  virtual ~PacketSource() = default;

  [[nodiscard]] virtual ReadStatus next(UdpPacket& packet) noexcept = 0;
};

}  // namespace landfix::platform
