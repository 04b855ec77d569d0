#include <algorithm>

#include "ndt/matcher.hpp"

namespace landfix::ndt {

Matcher::Matcher(const MatcherSettings& settings, std::size_t max_points)
    : settings_(settings),
      coarse_groups_(std::min(max_points, settings.few_points), kCoarseReach),
      leading_groups_(std::min(max_points, 2 * settings.few_points)),
      groups_(max_points) {}

}  // namespace landfix::ndt
