// A stream of frames through the frame parser and the reassembly: the link type, then for each frame its
// captured length, how much longer it was on the wire, and its bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "platform/big_endian.hpp"
#include "platform/udp_extractor.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  static const auto extractor = std::make_unique<UdpExtractor>();
  auto rest = std::as_bytes(std::span(data, size));
  if (rest.empty()) return 0;
  const auto link = static_cast<LinkType>(std::to_integer<unsigned>(rest[0]) % 5);
  rest = rest.subspan(1);
  std::int64_t stamp_utc_ns = 0;
  unsigned sum = 0;
  while (rest.size() >= 3) {
    const std::size_t captured = std::min<std::size_t>(load_be16(rest, 0) % 2048, rest.size() - 3);
    const std::size_t wire = captured + std::to_integer<std::size_t>(rest[2] & std::byte{1});
    const auto udp = extractor->extract(link, rest.subspan(3, captured), wire, stamp_utc_ns++);
    if (udp) {
      for (const std::byte byte : udp->payload) sum += std::to_integer<unsigned>(byte);
    }
    rest = rest.subspan(3 + captured);
  }
  extractor->finish();
  const CaptureCounters counters = extractor->counters();
  const std::uint64_t counted = counters.udp + counters.not_ip + counters.not_udp + counters.malformed +
                                counters.cut_short + counters.fragments;
  if (counted != counters.records) std::abort();
  return sum == 1 ? 1 : 0;
}
