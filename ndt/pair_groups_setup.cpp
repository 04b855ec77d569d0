#include "ndt/pair_groups.hpp"

namespace landfix::ndt {

PairGroups::PairGroups(std::size_t max_points)
    : points_m_(max_points),
      groups_((max_points + kGroupPoints - 1) / kGroupPoints),
      columns_(groups_.size()) {}

}  // namespace landfix::ndt
