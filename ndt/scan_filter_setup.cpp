// Set-up of the filters: the one place where they allocate.
#include "ndt/scan_filter.hpp"

namespace landfix::ndt {

ScanFilter::ScanFilter(const FilterSettings& settings, std::size_t capacity)
    : settings_(settings),
      grid_(settings.leaf_m, capacity,
            {.by_ring = settings.kind == FilterKind::ring,
             .with_entropy = settings.kind == FilterKind::entropy}),
      known_(settings.kind == FilterKind::entropy ? capacity : 0) {}

}  // namespace landfix::ndt
