// A trajectory; what parses must come back from what is written of it, but for the last digits.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "platform/trajectory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  std::vector<StampedPose> poses;
  try {
    poses = parse_tum({reinterpret_cast<const char*>(data), size}, "fuzz.tum");
  } catch (const std::runtime_error&) {
    return 0;
  }
  const std::vector<StampedPose> again = parse_tum(format_tum(poses), "again.tum");
  if (again.size() != poses.size()) std::abort();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (again[i].stamp_utc_ns != poses[i].stamp_utc_ns) std::abort();
  }
  return 0;
}
