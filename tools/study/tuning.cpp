#include "tools/study/tuning.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "platform/atomic_file.hpp"
#include "tools/study/localization.hpp"

namespace landfix::tools::study {
namespace {

/// Null where none holds.
[[nodiscard]] const Variation* best_of(std::span<const Variation> tried) {
  constexpr double kWorse = 1.2;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Variation& one : tried)
    if (is_whole(one.found)) least_m = std::min(least_m, one.found.position_rmse_m);
  const Variation* best = nullptr;
  for (const Variation& one : tried) {
    const bool is_good = is_whole(one.found) && one.found.position_rmse_m <= kWorse * least_m;
    if (is_good && (best == nullptr || one.found.cpu_ms < best->found.cpu_ms)) best = &one;
  }
  return best;
}

void write_configuration(const std::filesystem::path& drive, const Variation& chosen) {
  toml::table table = toml::parse_file((drive / "config.toml").string());
  table["sensor"].as_table()->insert_or_assign("max_range_m", chosen.max_range_m);
  table["filter"].as_table()->insert_or_assign("leaf_m", chosen.leaf_m);
  table["matcher"].as_table()->insert_or_assign("resolution_m", chosen.resolution_m);
  table["map"].as_table()->insert_or_assign("file", map_of(drive, chosen.resolution_m).filename().string());
  std::ostringstream text;
  text << fmt::format("# Tuned on this drive: {:.1f} cm and {:.3f} deg off, {:.2f} ms of CPU a sweep.\n",
                      100.0 * chosen.found.position_rmse_m, chosen.found.heading_rmse_deg,
                      chosen.found.cpu_ms)
       << table << '\n';
  platform::write_file(drive / "tuned.toml", text.str());
}

}  // namespace

void tune(const std::filesystem::path& drive, const Truth& truth, std::vector<Variation>& variations) {
  std::vector<Variation> tried;
  for (const double resolution_m : {1.0, 2.0}) {
    for (const double leaf_m : {1.0, 2.0, 3.0, 4.0}) {
      for (const double range_m : {200.0, 100.0, 50.0}) {
        Variation& one = tried.emplace_back();
        one.name = fmt::format("leaf {:g}, resolution {:g}, range {:g} m", leaf_m, resolution_m, range_m);
        one.leaf_m = leaf_m;
        one.resolution_m = resolution_m;
        one.max_range_m = range_m;
        one.found = localize(drive, truth, one).figures;
        one.found.along = {};
      }
    }
  }
  if (const Variation* const best = best_of(tried)) write_configuration(drive, *best);
  variations.insert(variations.end(), tried.begin(), tried.end());
}

}  // namespace landfix::tools::study
