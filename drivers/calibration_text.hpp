// Lines and numbers of calibration files, and the errors that say where they are wrong.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/beam.hpp"

namespace landfix::drivers {

/// Without blanks and line ends at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Cuts what is before the first `separator` off `text`, all of it where there is none.
[[nodiscard]] std::string_view take_until(std::string_view& text, char separator);

/// Nothing where it is not a finite number and nothing else; blanks around it and a plus sign are allowed.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

/// A file as text, without its byte order mark.
[[nodiscard]] std::string_view to_text(std::span<const std::byte> file);

/// Throws std::runtime_error: "NAME:LINE: WHAT".
[[noreturn]] void fail(std::string_view name, std::size_t line, const std::string& what);

/// `number` as the index of a beam, where beams are counted from `first`. `what` names it in the message.
/// Throws std::runtime_error where it is not one of `count` whole numbers.
[[nodiscard]] std::size_t to_index(double number, std::size_t first, std::size_t count, std::string_view what,
                                   std::string_view name, std::size_t line);

/// Ring 0 is the lowest beam; beams of equal elevation keep their order.
void rank_rings(std::vector<Beam>& beams);

}  // namespace landfix::drivers
