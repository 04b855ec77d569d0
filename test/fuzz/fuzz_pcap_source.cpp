// A whole capture file, through libpcap.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "fuzz/fuzz_file.hpp"
#include "platform/pcap_source.hpp"
#include "support/frames.hpp"

namespace {

/// A file of little endian, times in microseconds, Ethernet; one datagram whole and one in two fragments.
std::string sound_capture() {
  using namespace landfix::test;
  Bytes file = bytes({0xD4, 0xC3, 0xB2, 0xA1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 1, 0, 0, 0});
  const Bytes datagram = udp(payload(24));
  const Bytes first(datagram.begin(), datagram.begin() + 16);
  const Bytes second(datagram.begin() + 16, datagram.end());
  for (const Bytes& frame :
       {ethernet(ipv4(datagram)), ethernet(ipv4(first, {.identification = 2, .more = true})),
        ethernet(ipv4(second, {.identification = 2, .offset = 16}))}) {
    const auto size = static_cast<unsigned>(frame.size());
    file = file + bytes({0, 1, 2, 3, 4, 5, 6, 0, size, 0, 0, 0, size, 0, 0, 0}) + frame;
  }
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  static const int file = ::memfd_create("capture", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  static const std::string sound = sound_capture();
  const std::string capture = landfix::test::fuzzed_file(sound, std::span(data, size));
  const auto written = ::pwrite(file, capture.data(), capture.size(), 0);
  if (::ftruncate(file, written) != 0 || written != static_cast<ssize_t>(capture.size())) std::abort();
  try {
    PcapSource source(path);
    UdpPacket packet;
    unsigned sum = 0;
    while (source.next(packet) == ReadStatus::packet) {
      for (const std::byte byte : packet.payload) sum += std::to_integer<unsigned>(byte);
    }
    return sum == 1 ? 1 : 0;
  } catch (const std::runtime_error&) {
    return 0;
  }
}
