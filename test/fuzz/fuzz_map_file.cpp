// A map file: refused, or read within its bytes. The checksum is made right first, which no fuzzer would
// guess.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

#include "ndt/map_file.hpp"
#include "ndt/objective.hpp"
#include "ndt/pair_groups.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::ndt;
  static const std::vector<Eigen::Vector3f> scan = [] {
    std::vector<Eigen::Vector3f> points_m;
    for (float x = -8.0F; x < 8.0F; x += 1.7F) points_m.emplace_back(x, 0.3F * x, -0.2F * x);
    return points_m;
  }();
  static PairGroups groups(scan.size());
  std::vector<std::byte> file(size);
  if (size != 0) std::memcpy(file.data(), data, size);
  if (size >= sizeof(MapHeader)) {
    MapHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    header.magic = kMapMagic;
    header.version = kMapVersion;
    header.byte_order = kMapByteOrder;
    header.total_bytes = size;
    std::memcpy(file.data(), &header, sizeof header);
    header.checksum = map_checksum(file);
    std::memcpy(file.data(), &header, sizeof header);
  }
  try {
    const MapImage image = load_map(file, "fuzz.ndt");
    const VoxelMap map(image.bytes());
    groups.assign(scan, 1);
    (void)evaluate(map, groups, Pose::Identity(), Covariance::wide, {});
  } catch (const std::runtime_error&) {
  }
  return 0;
}
