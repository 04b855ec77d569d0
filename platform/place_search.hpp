// A vehicle that does not know where it is, looked for on the whole map while its solver goes on: that puts
// each sweep into a ring and takes what is known by then, and never waits. Whoever searches calls work() in a
// thread of its own (map_aid_threads.hpp), or between sweeps, which makes a replay repeatable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ndt/found.hpp"
#include "ndt/place_finder.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/relaxed_counter.hpp"
#include "platform/spsc_indices.hpp"
#include "platform/triple_buffer.hpp"

namespace landfix::platform {

/// Allocates in its constructor and prepare() only.
class PlaceSearch {
 public:
  /// The memory that `map` views must outlive it. Throws as PlanView::check_width does.
  explicit PlaceSearch(const ndt::VoxelMap& map);

  // For the solver.

  /// Where the vehicle was a sweep ago, for the sweep that is then put in: the answer to a search that began
  /// at least PlaceFinder::kSweepsASearch sweeps before it, however soon it was there. So the same sweeps get
  /// the same answers whenever the searcher is fast enough.
  [[nodiscard]] std::optional<ndt::Found> answer() noexcept;
  /// A sweep, which is counted here.
  void put(ndt::SoughtSweep sweep, std::span<const Eigen::Vector3f> points_m) noexcept;
  /// It knows where it is; the next sweep that is put in begins anew.
  void end() noexcept { is_first_ = true; }

  // For whoever searches.

  /// To be called first. Looks at all of the map, for which nobody else has to wait. Throws std::bad_alloc.
  void prepare();
  [[nodiscard]] bool is_prepared() const noexcept { return finder_.has_value(); }
  /// Looks at the oldest sweep, or at the newest if it is far behind and follows nothing; false if there is
  /// none.
  bool work() noexcept;

  // For whoever reports.

  /// Answers that were not there when they should have been, and sweeps without room in the ring.
  [[nodiscard]] std::uint64_t late() const noexcept { return late_; }
  /// Once it is prepared.
  [[nodiscard]] std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kSlots = 32;
  struct Slot {
    ndt::SoughtSweep sweep;
    std::size_t count = 0;  ///< of points
  };
  struct Report {
    std::uint64_t number = 0;  ///< of the sweep after which this is known
    std::optional<ndt::Found> found;
  };

  [[nodiscard]] std::span<Eigen::Vector3f> points_of(std::size_t slot) noexcept {
    return std::span(points_m_).subspan(slot * ndt::PlaceFinder::kMaxPoints, ndt::PlaceFinder::kMaxPoints);
  }

  ndt::VoxelMap map_;
  std::optional<ndt::PlaceFinder> finder_;
  SpscIndices<> indices_{kSlots};
  std::vector<Slot> slots_;
  std::vector<Eigen::Vector3f> points_m_;
  TripleBuffer<Report> reports_;

  // The solver's.
  std::uint64_t next_number_ = 1;
  std::uint64_t first_number_ = 1;  ///< of this search
  bool is_first_ = true;
  RelaxedCounter late_;
};

}  // namespace landfix::platform
