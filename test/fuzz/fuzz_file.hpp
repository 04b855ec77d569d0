// Text that is nearly sound: what a parser of files must stand.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace landfix::test {

/// The input itself where its first byte is even; else `sound`, changed by each four bytes of the input:
/// where (two bytes), how many characters go, and what comes instead. Where that is 0, all goes up to the
/// line's end; where it is 1, the rest of the line comes twice.
inline std::string fuzzed_text(const std::string& sound, std::span<const std::uint8_t> input) {
  if (input.empty() || input[0] % 2 == 0) {
    return {input.empty() ? input.begin() : input.begin() + 1, input.end()};
  }
  std::string text = sound;
  for (input = input.subspan(1); input.size() >= 4 && !text.empty(); input = input.subspan(4)) {
    const std::size_t at = (input[0] + 256U * input[1]) % text.size();
    const std::size_t to_end_of_line = std::min(text.find('\n', at), text.size() - 1) + 1 - at;
    if (input[3] == 0) {
      text.erase(at, to_end_of_line);
    } else if (input[3] == 1) {
      text.insert(at, std::string(text, at, to_end_of_line));
    } else {
      text.replace(at, input[2] % 4U, 1, static_cast<char>(input[3]));
    }
  }
  return text;
}

}  // namespace landfix::test
