#include "platform/place_search.hpp"

namespace landfix::platform {

PlaceSearch::PlaceSearch(const ndt::VoxelMap& map)
    : map_(map), slots_(kSlots), points_m_(kSlots * ndt::PlaceFinder::kMaxPoints, Eigen::Vector3f::Zero()) {
  ndt::PlanView::check_width(map);
}

void PlaceSearch::prepare() { finder_.emplace(map_); }

std::size_t PlaceSearch::memory_bytes() const noexcept {
  return (finder_ ? finder_->memory_bytes() : 0) + points_m_.size() * sizeof(Eigen::Vector3f) +
         slots_.size() * sizeof(Slot);
}

}  // namespace landfix::platform
