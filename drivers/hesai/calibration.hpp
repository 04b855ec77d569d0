// The calibration file of one unit: the angles of its channels, as it comes with the sensor or is read from
// it (user manuals). Firing times are the model's: no unit of the family brings a file of its own of them.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/beam.hpp"

namespace landfix::drivers::hesai {

/// Reads "channel,elevation,azimuth" lines, degrees, each channel 1 to N once, N = `table.size()`; what is
/// not in the file (firing times) is taken from the model's `table`, rings are ranked anew. A byte order
/// mark, CRLF, header lines and a trailing hash line are allowed. A file of another model is refused by its
/// channels or by where they point. Throws std::runtime_error with `name`, the line, what is wrong and what
/// to do.
[[nodiscard]] std::vector<Beam> parse_calibration(std::span<const std::byte> file, std::string_view name,
                                                  std::span<const Beam> table);

}  // namespace landfix::drivers::hesai
