// Writes UDP datagrams as a capture that any tool reads: Ethernet, IPv4, UDP, with checksums, times in ns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "platform/atomic_file.hpp"

namespace landfix::platform {

/// Addresses in host byte order: 192.168.1.201 is 0xC0A801C9.
struct UdpFlow {
  std::uint32_t source_address = 0;
  std::uint32_t destination_address = 0xFFFFFFFF;
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
};

/// The file appears, whole, with `commit`. Throws std::runtime_error with the path where writing fails.
class PcapWriter {
 public:
  /// A datagram that with its IP header exceeds `mtu_bytes` is split into fragments, as a network would.
  explicit PcapWriter(std::filesystem::path path, std::size_t mtu_bytes = 1500);

  /// `payload`: at most 65,507 bytes. `stamp_utc_ns`: from 1970 until 2106, all that the format can say.
  void write(const UdpFlow& flow, std::span<const std::byte> payload, std::int64_t stamp_utc_ns);

  void commit();

 private:
  void append_frame(const UdpFlow& flow, std::span<const std::byte> body, std::size_t offset, bool more,
                    std::int64_t stamp_utc_ns);
  void flush();

  std::filesystem::path path_;
  AtomicFile file_;
  std::size_t mtu_bytes_;
  std::uint16_t identification_ = 0;
  std::vector<std::byte> datagram_;
  std::vector<std::byte> buffer_;
};

}  // namespace landfix::platform
