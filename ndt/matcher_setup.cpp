#include <algorithm>

#include "ndt/matcher.hpp"

namespace landfix::ndt {

// A stride that is rounded down takes up to twice as many points as were asked for.
Matcher::Matcher(const MatcherSettings& settings, std::size_t max_points)
    : settings_(settings),
      coarse_groups_(std::min(max_points, 2 * settings.few_points), kCoarseReach),
      leading_groups_(std::min(max_points, 4 * settings.few_points)),
      groups_(max_points) {}

}  // namespace landfix::ndt
