#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

using testing::HasSubstr;

class EvaluateCommand : public testing::Test {
 protected:
  EvaluateCommand() {
    std::ofstream(reference_) << "1 0 0 0 0 0 0 1\n2 10 0 0 0 0 0 1\n3 20 0 0 0 0 0 1\n";
    std::ofstream(estimate_) << "1.5 5.5 0 0 0 0 0 1\n2.5 15.5 0 0 0 0 0 1\n";
  }

  int evaluate(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"evaluate", "--reference", reference_, "--estimate", estimate_};
    words.insert(words.end(), more.begin(), more.end());
    test::Outcome outcome = test::run_landfix(words);
    out_ = std::move(outcome.out);
    error_ = std::move(outcome.error);
    return outcome.code;
  }

  test::TemporaryDirectory directory_;
  std::filesystem::path reference_ = directory_.path() / "a.tum";
  std::filesystem::path estimate_ = directory_.path() / "b.tum";
  std::string out_;
  std::string error_;
};

TEST_F(EvaluateCommand, PrintsATable) {
  EXPECT_EQ(evaluate(), 0);
  EXPECT_THAT(out_, HasSubstr("2 poses compared"));
  EXPECT_THAT(out_, testing::ContainsRegex("position \\[m\\] +0.5000 +0.5000 +0.5000 +0.5000\n"));
}

TEST_F(EvaluateCommand, PrintsOneJsonObjectAndNothingElse) {
  EXPECT_EQ(evaluate({"--json", "--align", "first"}), 0);
  EXPECT_THAT(out_, testing::StartsWith("{\n  \"pairs\": 2,"));
  EXPECT_THAT(out_, testing::EndsWith("}\n"));
  EXPECT_EQ(error_, "");
}

TEST_F(EvaluateCommand, NoPairsExitsOneWithOneLine) {
  std::ofstream(estimate_) << "100 0 0 0 0 0 0 1\n";
  EXPECT_EQ(evaluate(), 1);
  EXPECT_THAT(error_, HasSubstr("no pose of the estimate"));
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1);
}

TEST_F(EvaluateCommand, WrongArgumentsExitTwo) {
  EXPECT_EQ(evaluate({"--align", "sim3"}), 2);
  EXPECT_EQ(evaluate({"--delta", "0"}), 2);
}

TEST_F(EvaluateCommand, ABadFileExitsOneAndNamesTheLine) {
  std::ofstream(estimate_) << "1 0 0\n";
  EXPECT_EQ(evaluate(), 1);
  EXPECT_THAT(error_, HasSubstr("b.tum:1: 3 columns"));
}

}  // namespace
}  // namespace landfix::tools
