// The frame table for others: as a DBC file, and as a table for people.
#pragma once

#include <cstdint>
#include <string>

namespace landfix::platform {

/// The content of a DBC file. ASCII alone; `base_id`: identifier of the first frame.
[[nodiscard]] std::string to_dbc(std::uint32_t base_id);

/// A table in Markdown, a row a frame.
[[nodiscard]] std::string to_markdown();

}  // namespace landfix::platform
