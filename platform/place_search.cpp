#include "platform/place_search.hpp"

#include <algorithm>

namespace landfix::platform {

std::optional<ndt::Found> PlaceSearch::answer() noexcept {
  if (is_first_) return std::nullopt;
  (void)reports_.update();
  const Report& report = reports_.front();
  const bool is_due = next_number_ - first_number_ >= ndt::PlaceFinder::kSweepsASearch;
  if (report.number + 1 != next_number_) {
    if (is_due) ++late_;
    return std::nullopt;
  }
  const bool has_waited =
      report.found && next_number_ - report.found->searched >= ndt::PlaceFinder::kSweepsASearch;
  return has_waited ? report.found : std::nullopt;
}

void PlaceSearch::put(ndt::SoughtSweep sweep, std::span<const Eigen::Vector3f> points_m) noexcept {
  sweep.number = next_number_++;
  if (indices_.writable(1) == 0) {
    ++late_;
    return;
  }
  sweep.is_first = is_first_;
  if (is_first_) first_number_ = sweep.number;
  is_first_ = false;
  const std::size_t slot = indices_.write_slot(0);
  const auto room_m = points_of(slot);
  const std::size_t count = std::min(points_m.size(), room_m.size());
  // Evenly over the sweep, in its order.
  for (std::size_t i = 0; i < count; ++i) room_m[i] = points_m[i * points_m.size() / count];
  slots_[slot] = {.sweep = sweep, .count = count};
  indices_.publish(1);
}

bool PlaceSearch::work() noexcept {
  if (!finder_) return false;
  const std::size_t waiting = indices_.readable(kSlots);
  if (waiting == 0) return false;
  // A search that has taken too long would else be followed by another in the past, and so for ever.
  if (!finder_->has_found() && waiting > ndt::PlaceFinder::kSweepsASearch) indices_.free(waiting - 1);
  const std::size_t slot = indices_.read_slot(0);
  const Slot& taken = slots_[slot];
  reports_.back() = {.number = taken.sweep.number,
                     .found = finder_->look(taken.sweep, points_of(slot).first(taken.count))};
  indices_.free(1);
  reports_.publish();
  return true;
}

}  // namespace landfix::platform
