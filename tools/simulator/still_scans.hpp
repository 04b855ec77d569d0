// Scans without motion distortion: each as if the vehicle had stood still for a turn of the sensor. What a
// matcher makes of them is its own doing, for their truth is exact.
#pragma once

#include <filesystem>

#include "tools/simulator/simulation.hpp"

namespace landfix::tools::simulator {

/// Writes scans/0000.pcd and on, frame `vehicle`, one for each whole turn of the drive, and scans.tum, where
/// the vehicle stood for each: where it is at the turn's end. Throws std::runtime_error where a file cannot
/// be written.
void write_still_scans(const Drive& drive, const std::filesystem::path& folder, const Progress& progress);

}  // namespace landfix::tools::simulator
