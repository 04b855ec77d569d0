// A map larger than memory: the tiles around the vehicle, loaded while it drives. The solver takes the newest
// window at the start of a sweep and says where it is; whoever loads calls load() in a thread of its own
// (map_aid_threads.hpp), or between sweeps, which makes a replay repeatable.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "ndt/map_window.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/hand_over.hpp"
#include "platform/page_memory.hpp"

namespace landfix::platform {

struct MapWindowSettings {
  std::size_t memory_bytes = 0;  ///< of both windows together, the one in use and the next
  double reach_m = 200.0;        ///< the farthest that the sensor sees
};

/// Sums over all windows that were loaded.
struct MapWindowCounters {
  std::uint64_t windows = 0;
  std::uint64_t tiles_not_fitting = 0;  ///< within reach, but without room
  std::uint64_t tiles_unreadable = 0;   ///< not read, or damaged
};

/// Allocates in its constructor only.
class MapWindow {
 public:
  /// Loads the window around `start_m`, or the map's middle. Throws std::runtime_error that says what is
  /// wrong with the file, or that the memory cannot be had.
  MapWindow(const std::filesystem::path& path, const MapWindowSettings& settings,
            const std::optional<Eigen::Vector3d>& start_m);

  /// Of the whole map; its counts are not the window's.
  [[nodiscard]] double resolution_m() const noexcept { return assembler_.map_header().resolution_m; }
  [[nodiscard]] std::uint32_t map_checksum() const noexcept {
    return assembler_.map_header().header_checksum;
  }

  /// Around what the first window was loaded.
  [[nodiscard]] const Eigen::Vector3d& start_m() const noexcept { return start_m_; }

  /// For the solver: the newest window, valid until the next call; `place_m` is where the vehicle is. Takes
  /// no lock and never waits.
  [[nodiscard]] ndt::VoxelMap newest(const Eigen::Vector3d& place_m) noexcept;

  /// For the loader: where the vehicle has left the middle of the last window, and the solver has taken it,
  /// loads the next one. Whether it did.
  bool load();
  [[nodiscard]] MapWindowCounters counters() const noexcept;

 private:
  void load_around(const Eigen::Vector3d& centre_m, std::size_t image);
  [[nodiscard]] Eigen::Vector3d middle_of(std::uint64_t block) const noexcept;

  ndt::WindowAssembler assembler_;
  Eigen::Vector3d start_m_;
  double reload_after_m_;
  std::array<PageMemory, 2> images_;
  HandOver hand_over_;
  Eigen::Vector3d loaded_around_m_ = Eigen::Vector3d::Zero();  ///< the loader's

  // The vehicle's block as its key: one word, so that it is never half of one place and half of the next.
  // relaxed: nothing else is read along with it.
  std::atomic<std::uint64_t> place_{0};
  // Written by the loader, read by whoever reports; relaxed, as they are only counted.
  std::atomic<std::uint64_t> windows_{0};
  std::atomic<std::uint64_t> tiles_not_fitting_{0};
  std::atomic<std::uint64_t> tiles_unreadable_{0};
};

}  // namespace landfix::platform
