#include "platform/udp_extractor.hpp"

namespace landfix::platform {

std::optional<UdpDatagram> UdpExtractor::extract(LinkType link, std::span<const std::byte> captured,
                                                 std::size_t wire_bytes, std::int64_t stamp_utc_ns) noexcept {
  ++counters_.records;
  const Frame frame = parse_frame(link, captured, wire_bytes);
  switch (frame.status) {
    case FrameStatus::udp:
      ++counters_.udp;
      return frame.udp;
    case FrameStatus::fragment:
      return reassembly_.add(frame.fragment, stamp_utc_ns);
    case FrameStatus::not_ip:
      ++counters_.not_ip;
      break;
    case FrameStatus::not_udp:
      ++counters_.not_udp;
      break;
    case FrameStatus::malformed:
      ++counters_.malformed;
      break;
    case FrameStatus::cut_short:
      ++counters_.cut_short;
      break;
  }
  return std::nullopt;
}

void UdpExtractor::count_malformed() noexcept {
  ++counters_.records;
  ++counters_.malformed;
}

CaptureCounters UdpExtractor::counters() const noexcept {
  CaptureCounters counters = counters_;
  const ReassemblyCounters& reassembly = reassembly_.counters();
  counters.fragments = reassembly.fragments;
  counters.reassembled = reassembly.reassembled;
  counters.fragments_duplicate = reassembly.duplicates;
  counters.fragments_dropped = reassembly.dropped;
  return counters;
}

}  // namespace landfix::platform
