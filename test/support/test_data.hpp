// Where tests find real captures, and files of their own.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include <gtest/gtest.h>
#include <unistd.h>

namespace landfix::test {

/// A real capture below LANDFIX_TEST_DATA; empty where there is none.
[[nodiscard]] inline std::filesystem::path real_data(const std::string& name) {
  const char* const folder = std::getenv("LANDFIX_TEST_DATA");
  if (folder == nullptr) return {};
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

/// All of a file; empty where there is none.
[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A folder that is gone when the test is.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "landfix-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace landfix::test

/// Defines `variable` as the path of a real capture, or skips the test, saying so.
#define LANDFIX_REAL_DATA(variable, name)                                  \
  const std::filesystem::path variable = ::landfix::test::real_data(name); \
  if (variable.empty()) GTEST_SKIP() << "no real data: LANDFIX_TEST_DATA has no " << (name)
