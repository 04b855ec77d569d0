// Part of a map that is larger than memory: the tiles around a place, put together from the file as a map
// image of their own. Reads through a callable, since files belong above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ndt/map_layout.hpp"
#include "ndt/map_middle.hpp"

namespace landfix::ndt {

/// Fills `into` with the bytes of the map file from `offset` on; false where it cannot.
using ReadAt = std::function<bool(std::uint64_t offset, std::span<std::byte> into)>;

/// What a map file holds, without its voxels.
struct MapDirectory {
  MapHeader header;
  std::vector<TileBlock> blocks;
  std::vector<TileEntry> tiles;
};

/// Throws std::runtime_error that begins with `name` and says why the file is not a usable map.
[[nodiscard]] MapDirectory read_map_directory(const ReadAt& read_at, std::uint64_t file_bytes,
                                              const std::string& name);

/// What came of putting a window together.
struct WindowContent {
  std::size_t tiles = 0;              ///< in the window
  std::size_t voxels = 0;             ///< of these
  std::size_t tiles_not_fitting = 0;  ///< within the radius, but without room
  std::size_t tiles_unreadable = 0;   ///< that could not be read, or whose checksum is wrong
};

/// Allocates in its constructor only.
class WindowAssembler {
 public:
  /// `radius_m`: of the window, horizontally.
  WindowAssembler(MapDirectory directory, ReadAt read_at, double radius_m);

  [[nodiscard]] const MapHeader& map_header() const noexcept { return directory_.header; }
  /// Of the whole map (map_middle.hpp).
  [[nodiscard]] Eigen::Vector3d map_middle_m() const noexcept {
    return middle_m(directory_.blocks, directory_.header.resolution_m);
  }

  /// Makes a map image in `memory`, which is aligned to 64 bytes and holds at least an empty map: of the
  /// tiles within the radius of `centre_m` as many as fit, the nearest first. A tile that cannot be had is
  /// left out.
  WindowContent assemble(std::span<std::byte> memory, const Eigen::Vector3d& centre_m);

 private:
  struct Candidate {
    double distance_m = 0.0;
    std::uint32_t tile = 0;
  };

  /// The tiles to load, in the map's order; the counts of the others go into `content`.
  [[nodiscard]] std::span<const Candidate> choose(std::size_t bytes, const Eigen::Vector3d& centre_m,
                                                  MapHeader& header, WindowContent& content);
  [[nodiscard]] double distance_m(const TileEntry& tile, const Eigen::Vector3d& place_m) const noexcept;

  MapDirectory directory_;
  ReadAt read_at_;
  double radius_m_;
  std::vector<Candidate> candidates_;
};

}  // namespace landfix::ndt
