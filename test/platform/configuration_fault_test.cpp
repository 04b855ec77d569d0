// Each mistake in each key of the documented configuration: one line that says where and what is allowed.
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/atomic_file.hpp"
#include "platform/configuration.hpp"
#include "support/error_of.hpp"

namespace landfix::platform {
namespace {

const std::filesystem::path kExample = std::filesystem::path(LANDFIX_CONFIG_FOLDER) / "landfix.toml";

struct Lines {
  std::vector<std::string> all;
  std::string joined() const {
    std::string text;
    for (const std::string& line : all) text += line + '\n';
    return text;
  }
};

Lines example() {
  const std::vector<std::byte> bytes = read_file(kExample);
  std::istringstream text(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  Lines lines;
  for (std::string line; std::getline(text, line);) lines.all.push_back(line);
  return lines;
}

/// Values that no key of this kind takes.
std::vector<std::string> bad_values(const std::string& value) {
  if (value.starts_with('"')) return {"1", "true", "[]"};  // what strings may say is each key's own affair
  if (value.starts_with('[')) return {"1", "\"x\"", "[1, 2]", "[nan, 0, 0, 0, 0, 0]"};
  if (value == "true" || value == "false") return {"1", "\"true\"", "[]"};
  return {"\"1\"", "true", "[]", "-1e30", "1e30", "nan"};
}

TEST(ConfigurationFaults, EachMistakeInEachKeyIsOneLineThatSaysWhere) {
  const std::regex key_line(R"(^([a-z_]+) = ("[^"]*"|\[[^\]]*\]|[^ #]+).*$)");
  const Lines sound = example();
  ASSERT_NO_THROW((void)parse_configuration(sound.joined(), kExample));
  std::size_t mistakes = 0;
  for (std::size_t i = 0; i < sound.all.size(); ++i) {
    std::smatch found;
    if (!std::regex_match(sound.all[i], found, key_line)) continue;
    const std::string key = found[1];
    std::vector<std::string> bad{key + "x = " + found[2].str(), key + " ="};
    for (const std::string& value : bad_values(found[2])) bad.push_back(key + " = " + value);
    bad.push_back(sound.all[i] + '\n' + sound.all[i]);  // twice
    for (const std::string& line : bad) {
      Lines spoilt = sound;
      spoilt.all[i] = line;
      const std::string text = spoilt.joined();
      const std::string error = test::error_of([&] { return parse_configuration(text, "a.toml"); });
      // A misspelt key that is required is missing, which has no place.
      const bool is_placed = error.starts_with(fmt::format("a.toml:{}:", i + 1)) ||
                             error.starts_with(fmt::format("a.toml:{}:", i + 2));
      EXPECT_TRUE(is_placed || error.starts_with("a.toml: " + key + " is missing")) << line << '\n' << error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
      ++mistakes;
    }
  }
  EXPECT_GT(mistakes, 150U);
}

}  // namespace
}  // namespace landfix::platform
