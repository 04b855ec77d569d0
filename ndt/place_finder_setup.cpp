#include "ndt/place_finder.hpp"

namespace landfix::ndt {

PlaceFinder::PlaceFinder(const VoxelMap& map)
    : map_(map), plan_(map_), relocalizer_(plan_, kMaxPoints), track_(FitGates{}) {}

}  // namespace landfix::ndt
