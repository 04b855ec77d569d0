// What the pages for a browser share. They need no network, and are well-formed as XML too.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace landfix::tools {

/// As it can stand in a page, also within quotes.
[[nodiscard]] std::string html_of(std::string_view text);

/// Until after the title, with the style of everything below it.
[[nodiscard]] std::string html_head(std::string_view title);
inline constexpr std::string_view kHtmlTail = "</main></body></html>\n";

enum class Mood : std::uint8_t { plain, good, bad };

/// A figure and what it is, for a <div class="tiles">.
[[nodiscard]] std::string tile(const std::string& value, std::string_view what, Mood mood = Mood::plain);

}  // namespace landfix::tools
