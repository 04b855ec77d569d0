// Runs `landfix` within the test's own process and keeps what it prints.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tools/command.hpp"

namespace landfix::test {

struct Outcome {
  int code = 0;
  std::string out;
  std::string error;
};

/// `words`: what follows the program's name.
[[nodiscard]] inline Outcome run_landfix(const std::vector<std::string>& words) {
  std::vector<const char*> arguments{"landfix"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.code = tools::run(static_cast<int>(arguments.size()), arguments.data());
  std::fflush(stdout);
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.error = testing::internal::GetCapturedStderr();
  return outcome;
}

}  // namespace landfix::test
