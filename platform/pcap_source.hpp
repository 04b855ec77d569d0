// The packets of a capture file, pcap or pcapng, in place of a socket.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "platform/packet_source.hpp"
#include "platform/udp_extractor.hpp"

struct pcap;

namespace landfix::platform {

/// Delivers every UDP datagram of the file, reassembled where IP split it; everything else is counted.
class PcapSource final : public PacketSource {
 public:
  /// Throws std::runtime_error with the path, the reason and what to do.
  explicit PcapSource(std::filesystem::path path);

  /// Does not allocate, but that libpcap grows its buffer for a record larger than 2 KiB and all before it.
  [[nodiscard]] ReadStatus next(UdpPacket& packet) noexcept override;

  /// Back to the first packet, counters at zero. Opens the file again: for set-up, and may throw as it did.
  void rewind();

  /// The same, but a pcap file stays open, so that it does not allocate; a pcapng file is opened anew. False
  /// where it cannot be done: a pipe, a file that is gone.
  [[nodiscard]] bool restart() noexcept;

  [[nodiscard]] CaptureCounters counters() const noexcept { return extractor_->counters(); }

  /// Why `next` returned `truncated`, else empty.
  [[nodiscard]] const char* read_error() const noexcept { return read_error_; }

  /// How far reading has come, for progress, 0 to 100; 0 where the file has no size (a pipe).
  [[nodiscard]] double percent_read() const noexcept;

 private:
  struct Close {
    void operator()(pcap* handle) const noexcept;
  };

  std::filesystem::path path_;
  std::unique_ptr<pcap, Close> capture_;
  LinkType link_ = LinkType::ethernet;
  std::unique_ptr<UdpExtractor> extractor_;
  const char* read_error_ = "";
  std::uint64_t total_bytes_ = 0;
  std::int64_t first_record_ = -1;  ///< where it begins in the file; -1: there is more to reading it again
};

}  // namespace landfix::platform
