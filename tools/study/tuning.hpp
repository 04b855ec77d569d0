// Leaf, resolution and range for one sensor on one route, by the measured trade of time against error.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/study/along.hpp"
#include "tools/study/figures.hpp"

namespace landfix::tools::study {

/// Localizes a drive of `landfix simulate` with every setting of a grid, adds what it found to `variations`
/// and writes tuned.toml beside its config.toml: the fastest, by CPU time, of the settings that never lose
/// the vehicle and err, in position, at most a fifth more than the best. No file where there is none.
void tune(const std::filesystem::path& drive, const Truth& truth, std::vector<Variation>& variations);

}  // namespace landfix::tools::study
