// Files that are nearly sound: what a parser of files must stand.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace landfix::test {

/// The input itself where its first byte is even; else `sound`, changed by each four bytes of the input:
/// where (two bytes), how many bytes go, up to three, and what comes instead.
inline std::string fuzzed_file(const std::string& sound, std::span<const std::uint8_t> input,
                               bool has_lines = false) {
  if (input.empty() || input[0] % 2 == 0) {
    return {input.empty() ? input.begin() : input.begin() + 1, input.end()};
  }
  std::string file = sound;
  for (input = input.subspan(1); input.size() >= 4 && !file.empty(); input = input.subspan(4)) {
    const std::size_t at = (input[0] + 256U * input[1]) % file.size();
    const std::size_t rest_of_line = std::min(file.find('\n', at), file.size() - 1) + 1 - at;
    if (has_lines && input[3] == 0) {
      file.erase(at, rest_of_line);
    } else if (has_lines && input[3] == 1) {
      if (file.size() > 2 * sound.size()) break;  // else it would double with every change
      file.insert(at, std::string(file, at, rest_of_line));
    } else {
      file.replace(at, input[2] % 4U, 1, static_cast<char>(input[3]));
    }
  }
  return file;
}

/// The same of text; where 0 comes instead, the rest of the line goes, where 1 does, it comes twice.
inline std::string fuzzed_text(const std::string& sound, std::span<const std::uint8_t> input) {
  return fuzzed_file(sound, input, true);
}

}  // namespace landfix::test
