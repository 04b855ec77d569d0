// One sensor on one route, from the simulated drive to the figures.
#pragma once

#include <filesystem>

#include "tools/study/figures.hpp"

namespace landfix::tools::study {

/// Works in `folder`, which holds the surveyed map, trajectories, metrics and pictures afterwards; the
/// capture and the clouds only if they are to be kept.
[[nodiscard]] CaseFigures run_case(const Case& one, const std::filesystem::path& folder);

}  // namespace landfix::tools::study
