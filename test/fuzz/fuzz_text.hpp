// Text that is nearly sound: what a parser of files must stand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace landfix::test {

/// The input itself where its first byte is even; else `sound`, each three bytes of the input changing one
/// character or, where the character is 0, cutting out what follows up to the line's end.
inline std::string fuzzed_text(const std::string& sound, std::span<const std::uint8_t> input) {
  if (input.empty() || input[0] % 2 == 0) {
    return {input.empty() ? input.begin() : input.begin() + 1, input.end()};
  }
  std::string text = sound;
  for (input = input.subspan(1); input.size() >= 3 && !text.empty(); input = input.subspan(3)) {
    const std::size_t at = (input[0] + 256U * input[1]) % text.size();
    if (input[2] == 0) {
      text.erase(at, text.find('\n', at) - at);
    } else {
      text[at] = static_cast<char>(input[2]);
    }
  }
  return text;
}

}  // namespace landfix::test
