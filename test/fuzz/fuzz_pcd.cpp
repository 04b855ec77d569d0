// A point cloud: any bytes are read or refused.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "fuzz/fuzz_file.hpp"
#include "ndt/pcd.hpp"

namespace {

/// Two points as each kind of data; the compressed one is the binary one, column by column, as literals.
std::array<std::string, 3> sound_clouds() {
  const auto header = [](const char* data) {
    return std::string(
               "# .PCD v0.7\nVERSION 0.7\nFIELDS ring x y z\nSIZE 2 4 4 4\nTYPE U F F F\nCOUNT 1 1 1 1\n"
               "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ") +
           data + "\n";
  };
  const std::string point("\x07\x00\x00\x00\x80\x3F\x00\x00\x00\x40\x00\x00\x40\x40", 14);
  const std::string sizes("\x1D\x00\x00\x00\x1C\x00\x00\x00", 8);
  return {header("ascii") + "7 1 2 3\n65535 -4 5.5 6e0\n", header("binary") + point + point,
          header("binary_compressed") + sizes + "\x1B" + point + point};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto sounds = sound_clouds();
  const std::string& sound = sounds[size == 0 ? 0 : data[0] / 2 % sounds.size()];
  const std::string file = landfix::test::fuzzed_file(sound, std::span(data, size));
  std::size_t points = 0;
  try {
    landfix::ndt::visit_pcd_positions(std::as_bytes(std::span(file)), "fuzz.pcd",
                                      [&points](const Eigen::Vector3d& /*position_m*/) { ++points; });
  } catch (const std::runtime_error&) {
  }
  return 0;
}
