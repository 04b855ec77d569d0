// A capture localized in its surveyed map, by the reference study's settings or with something set otherwise.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "platform/trajectory.hpp"
#include "tools/study/along.hpp"
#include "tools/study/figures.hpp"

namespace landfix::tools::study {

/// The map of a drive's survey at that resolution, made if it is not there yet.
std::filesystem::path map_of(const std::filesystem::path& drive, double resolution_m);

/// No sweep but the first ones was without a pose.
[[nodiscard]] bool is_whole(const LocalizationFigures& figures) noexcept;

struct Localization {
  LocalizationFigures figures;
  std::vector<platform::StampedPose> trajectory;  ///< the usable poses
};

/// `drive`: a folder of `landfix simulate`. `variation.found` is not read.
[[nodiscard]] Localization localize(const std::filesystem::path& drive, const Truth& truth,
                                    const Variation& variation);

/// What the study varies, one thing after the other: range, leaf, filter, resolution, deskew.
[[nodiscard]] std::span<const Variation> ablations();

}  // namespace landfix::tools::study
