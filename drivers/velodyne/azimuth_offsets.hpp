// What the table of the VLS-128 leaves to the single unit: small azimuth errors of its lasers. A recorded one
// showed up to 0.03 deg on smooth walls, too little to correct by default. No vendor file holds them; these
// are measured on walls.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/beam.hpp"

namespace landfix::drivers::velodyne {

/// Reads "laser_id,azimuth_offset_deg" lines, each laser at most once, and adds the offsets to those of the
/// model's `table`. A byte order mark, CRLF, blank lines and one header line are allowed. Throws
/// std::runtime_error with `name`, the line, what is wrong and what to do.
[[nodiscard]] std::vector<Beam> parse_azimuth_offsets(std::span<const std::byte> file, std::string_view name,
                                                      std::span<const Beam> table);

}  // namespace landfix::drivers::velodyne
