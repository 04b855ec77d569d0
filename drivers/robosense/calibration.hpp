// The angle file of one unit, as it is on the USB stick that comes with it.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/beam.hpp"

namespace landfix::drivers::robosense {

/// Reads "vertical,horizontal" lines, degrees, one a laser in the order of the slots; rings are ranked. A
/// byte order mark, CRLF and blank lines are allowed. Throws std::runtime_error with `name`, the line, what
/// is wrong and what to do.
[[nodiscard]] std::vector<Beam> parse_calibration(std::span<const std::byte> file, std::string_view name,
                                                  std::size_t lasers);

}  // namespace landfix::drivers::robosense
