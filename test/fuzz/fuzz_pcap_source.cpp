// A whole capture file, through libpcap.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "platform/pcap_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  static const int file = ::memfd_create("capture", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
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
