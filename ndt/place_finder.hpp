// Finds a vehicle anywhere on the map, beside whoever has to be in time: a sweep is searched with, which
// takes longer than one, and those that came meanwhile are matched in turn from where it was found, which
// takes less, until what is known is of the newest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "ndt/found.hpp"
#include "ndt/plan_view.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/relocalizer.hpp"
#include "ndt/track.hpp"
#include "ndt/voxel_map.hpp"

namespace landfix::ndt {

/// What is known of a sweep beside its points.
struct SoughtSweep {
  std::uint64_t number = 0;  ///< one more than that of the sweep before
  bool is_first = false;     ///< from here on a vehicle is looked for anew
  std::int64_t stamp_utc_ns = 0;
  Velocity undistorted_with = Velocity::Zero();
  std::optional<PoseGuess> area{};  ///< to look in; nothing: the whole map
};

/// Allocates in its constructor only.
class PlaceFinder {
 public:
  /// More points than these tell no more of where one is.
  static constexpr std::size_t kMaxPoints = 1536;

  /// The memory that `map` views must outlive it. Throws as PlanView does.
  explicit PlaceFinder(const VoxelMap& map);

  /// One search in so many sweeps, and the time it may take before anyone waits for it: so that it is known
  /// beforehand which sweeps are searched with, and from which on an answer is used.
  static constexpr std::uint64_t kSweepsASearch = 5;

  /// The next sweep. `points_m`: deskewed and filtered, at most kMaxPoints of them. What is known afterwards:
  /// nothing while it has not been found, or has been lost again.
  [[nodiscard]] std::optional<Found> look(const SoughtSweep& sweep,
                                          std::span<const Eigen::Vector3f> points_m) noexcept;

  /// Whether there is something to follow: else the newest sweep is as good as any.
  [[nodiscard]] bool has_found() const noexcept { return track_.exists(); }

  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return plan_.memory_bytes() + relocalizer_.memory_bytes();
  }

 private:
  VoxelMap map_;
  PlanView plan_;
  Relocalizer relocalizer_;
  Track track_;
  std::uint64_t searched_ = 0;     ///< number of the sweep that was searched with last
  std::uint64_t next_search_ = 0;  ///< number of the first sweep that may be
};

}  // namespace landfix::ndt
