#include "ndt/scan_filter.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::ndt {

std::optional<FilterKind> find_filter(std::string_view name) noexcept {
  const auto* const found = std::find(kFilterNames.begin(), kFilterNames.end(), name);
  if (found == kFilterNames.end()) return std::nullopt;
  return static_cast<FilterKind>(found - kFilterNames.begin());
}

void ScanFilter::add(std::span<const Eigen::Vector3f> points_m,
                     std::span<const std::uint16_t> rings) noexcept {
  if (settings_.kind != FilterKind::ring || rings.empty()) {
    grid_.add(points_m);
  } else {
    for (std::size_t n = 0; n < points_m.size(); ++n) grid_.add(points_m[n], rings[n]);
  }
}

std::span<Eigen::Vector3f> ScanFilter::finish() noexcept {
  const std::span<Eigen::Vector3f> points_m = grid_.finish();
  return settings_.kind == FilterKind::entropy ? keep_lowest_entropy(points_m) : points_m;
}

/// A cell with too few points for an entropy is not kept: what explains it is not known.
std::span<Eigen::Vector3f> ScanFilter::keep_lowest_entropy(std::span<Eigen::Vector3f> points_m) noexcept {
  const std::span<const float> entropies = grid_.entropies().first(points_m.size());
  const auto end = std::copy_if(entropies.begin(), entropies.end(), known_.begin(),
                                [](float entropy) { return !std::isnan(entropy); });
  const std::span<float> known = std::span(known_).first(static_cast<std::size_t>(end - known_.begin()));
  const auto wanted =
      static_cast<std::size_t>(std::ceil(settings_.entropy_share * static_cast<double>(points_m.size())));
  const std::size_t most = std::min(wanted, known.size());
  if (most == 0) return {};
  const auto highest = known.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(known.begin(), highest, known.end());
  // In place and in order; of equal ones at the limit the first, so that there are never more than wanted.
  std::size_t kept = 0;
  for (std::size_t n = 0; n < points_m.size() && kept < most; ++n) {
    if (entropies[n] <= *highest) points_m[kept++] = points_m[n];
  }
  return points_m.first(kept);
}

}  // namespace landfix::ndt
