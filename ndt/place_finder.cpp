#include "ndt/place_finder.hpp"

namespace landfix::ndt {

namespace {

/// Who takes the answer judges the sweep that it takes it for.
constexpr double kAnyExplained = 0.0;

}  // namespace

std::optional<Found> PlaceFinder::look(const SoughtSweep& sweep,
                                       std::span<const Eigen::Vector3f> points_m) noexcept {
  if (sweep.is_first) {
    next_search_ = sweep.number;
    track_.drop();
  }
  if (track_.exists()) {
    if (track_.is_splinter(sweep.stamp_utc_ns)) return std::nullopt;
    const StampedPose expected{sweep.stamp_utc_ns, track_.expected_at(sweep.stamp_utc_ns)};
    const MatchResult match = relocalizer_.match(map_, points_m, expected.pose);
    track_.follow(match, expected, sweep.undistorted_with, kAnyExplained);
  } else if (sweep.number >= next_search_) {
    const Location location = relocalizer_.locate(map_, points_m, sweep.area);
    searched_ = sweep.number;
    next_search_ = sweep.number + kSweepsASearch;
    if (location.sure) {
      const MatchResult& best = location.candidates[0].match;
      track_.begin({sweep.stamp_utc_ns, best.pose}, best.explained(), sweep.undistorted_with,
                   sweep.undistorted_with);
    }
  }
  if (!track_.exists()) return std::nullopt;
  return Found{.at = track_.at(), .velocity = track_.velocity(), .searched = searched_};
}

}  // namespace landfix::ndt
