// The small files of /proc and /sys: one value each, or absent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace landfix::tools {

/// Without the blanks at its end; nothing where it cannot be read.
[[nodiscard]] std::optional<std::string> read_host_file(const std::filesystem::path& path);
/// Decimal, or hexadecimal after 0x.
[[nodiscard]] std::optional<std::int64_t> read_host_number(const std::filesystem::path& path);
/// What stands between brackets: "always [madvise] never".
[[nodiscard]] std::string bracketed(std::string_view text);
/// "0-3,6"; what is no core is left out.
[[nodiscard]] std::vector<int> parse_cores(std::string_view list);
/// Its entries by name, those that begin with `prefix`; none where there is no such folder.
[[nodiscard]] std::vector<std::filesystem::path> host_entries(const std::filesystem::path& folder,
                                                              std::string_view prefix);

}  // namespace landfix::tools
