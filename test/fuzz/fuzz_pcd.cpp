// A point cloud: any bytes are read or refused.
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "ndt/pcd.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::size_t points = 0;
  try {
    landfix::ndt::visit_pcd_positions(std::as_bytes(std::span(data, size)), "fuzz.pcd",
                                      [&points](const Eigen::Vector3d& /*position_m*/) { ++points; });
  } catch (const std::runtime_error&) {
  }
  return 0;
}
