// A capture mapped twice, at one reading: as landfix does it, and as the reference study did.
#pragma once

#include <filesystem>

#include "tools/decoded_capture.hpp"
#include "tools/study/along.hpp"
#include "tools/study/figures.hpp"

namespace landfix::tools::study {

struct Mappings {
  MappingFigures by_landfix;
  MappingFigures by_study;
};

/// Leaves mapping/ and study-mapping/ in `drive`, as `landfix mapping` writes them. Both begin at the first
/// sweep's true pose.
[[nodiscard]] Mappings map_drive(const std::filesystem::path& drive, const CaptureInput& input,
                                 const Truth& truth);

struct CloudQuality {
  double mean_map_entropy = 0.0;
  double mean_plane_variance_m = 0.0;
};

/// By a sample of its points.
[[nodiscard]] CloudQuality quality_of(const std::filesystem::path& cloud);

}  // namespace landfix::tools::study
