// A map file: refused, or read within its bytes, whole or as a window. The checksums are made right first,
// which no fuzzer would guess.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/fuzz_file.hpp"
#include "ndt/map_file.hpp"
#include "ndt/map_window.hpp"
#include "ndt/objective.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/voxel_map_builder.hpp"

namespace {

using namespace landfix::ndt;

/// Three voxels in two blocks.
std::string sound_map() {
  VoxelMapBuilder builder(1.0, 8);
  for (const double x_m : {0.0, 1.0, 6.0}) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d offset_m(0.2 + 0.4 * (corner & 1U), 0.3 + 0.2 * (corner >> 1U & 1U),
                                     0.4 + 0.3 * (corner >> 2U));
      builder.add(Eigen::Vector3d(x_m, 0.0, 0.0) + offset_m);
    }
  }
  const MapImage image = builder.build();
  return {reinterpret_cast<const char*>(image.bytes().data()), image.bytes().size()};
}

/// Magic, version, byte order, size and checksums as they should be.
void make_credible(std::span<std::byte> file) {
  if (file.size() < sizeof(MapHeader)) return;
  MapHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  header.magic = kMapMagic;
  header.version = kMapVersion;
  header.byte_order = kMapByteOrder;
  header.total_bytes = file.size();
  std::memcpy(file.data(), &header, sizeof header);
  const bool counts_are_small =
      std::max({header.table_size, header.voxel_count, header.block_count, header.tile_count}) <= file.size();
  if (counts_are_small && MapLayout(header).end == file.size()) seal_map(file);
}

/// Reads two tiles or so of the file, if it is one.
void read_window(std::span<const std::byte> file) {
  const ReadAt read_at = [file](std::uint64_t offset, std::span<std::byte> into) {
    if (offset > file.size() || into.size() > file.size() - offset) return false;
    std::copy_n(file.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
    return true;
  };
  WindowAssembler windows(read_map_directory(read_at, file.size(), "fuzz.ndt"), read_at, 10.0);
  MapMemory memory(2048);
  (void)windows.assemble(memory.bytes(), Eigen::Vector3d::Zero());
  visit_voxels(VoxelMap(memory.bytes()), [](const Voxel& /*voxel*/, const Eigen::Vector3d& /*mean_m*/) {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string sound = sound_map();
  static const std::vector<Eigen::Vector3f> scan = [] {
    std::vector<Eigen::Vector3f> points_m;
    for (float x = -8.0F; x < 8.0F; x += 1.7F) points_m.emplace_back(x, 0.3F * x, -0.2F * x);
    return points_m;
  }();
  static PairGroups groups(scan.size());
  std::string file = landfix::test::fuzzed_file(sound, std::span(data, size));
  const auto bytes = std::as_writable_bytes(std::span(file));
  make_credible(bytes);
  try {
    read_window(bytes);
    const MapImage image = load_map(bytes, "fuzz.ndt");
    const VoxelMap map(image.bytes());
    groups.assign(scan);
    (void)evaluate(map, groups, Pose::Identity(), Covariance::wide, {});
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
