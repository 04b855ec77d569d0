// A sweep as the study shows it: laid over the map, and thinned and cut at several ranges.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "platform/trajectory.hpp"
#include "tools/decoded_capture.hpp"

namespace landfix::tools::study {

/// Writes scan.svg and filtered.svg to `drive`: the first sweep that ends after `stamp_utc_ns`, where the
/// localized trajectory has it. False where it has none there.
bool draw_sweep(const std::filesystem::path& drive, const CaptureInput& input,
                std::span<const platform::StampedPose> trajectory, std::int64_t stamp_utc_ns);

}  // namespace landfix::tools::study
