// Latencies as text; what parses must come back from what is written of it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "platform/hgrm.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  LatencyDistribution distribution;
  try {
    distribution = parse_hgrm({reinterpret_cast<const char*>(data), size}, "fuzz.hgrm");
  } catch (const std::runtime_error&) {
    return 0;
  }
  const LatencyDistribution again = parse_hgrm(to_hgrm(distribution), "again.hgrm");
  if (again.count() != distribution.count()) std::abort();
  return 0;
}
