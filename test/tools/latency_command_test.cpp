#include <fstream>
#include <memory>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/hgrm.hpp"
#include "support/error_of.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/latency_table.hpp"

namespace landfix::tools {
namespace {

using platform::distribution_of;
using platform::hgrm_of_stage;
using platform::to_hgrm;
using test::error_of;
using ::testing::HasSubstr;

/// 10,000 values around 0.5 ms.
std::unique_ptr<platform::LatencyHistogram> some_latencies() {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> duration_ns(13.1, 0.4);
  auto histogram = std::make_unique<platform::LatencyHistogram>();
  for (int i = 0; i < 10'000; ++i) histogram->record(static_cast<std::int64_t>(duration_ns(random)));
  return histogram;
}

/// As HdrHistogram's Java writes it: 1, 2, ... 10 ms.
constexpr const char* kOfJava =
    "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
    "       1.000 0.000000000000          1           1.00\n"
    "       5.000 0.500000000000          5           2.00\n"
    "       9.000 0.900000000000          9          10.00\n"
    "      10.003 0.950000000000         10          20.00\n"
    "      10.003 1.000000000000         10\n"
    "#[Mean    =        5.500, StdDeviation   =        2.872]\n"
    "#[Max     =       10.000, Total count    =           10]\n"
    "#[Buckets =           17, SubBuckets     =         2048]\n";

TEST(LatencyCommand, PutsAllStagesIntoOneTable) {
  const test::TemporaryDirectory directory;
  const auto histogram = some_latencies();
  const std::filesystem::path whole = directory.path() / "drive.hgrm";
  std::ofstream(whole) << to_hgrm(distribution_of(*histogram, "total"));
  std::ofstream(hgrm_of_stage(whole, "match")) << to_hgrm(distribution_of(*histogram, "match"));
  const test::Outcome table = test::run_landfix({"latency", whole.string()});
  EXPECT_EQ(table.code, 0) << table.error;
  EXPECT_THAT(table.out, HasSubstr("\nmatch "));
  EXPECT_THAT(table.out, HasSubstr("MET    p50 1, p99.9 2"));
  EXPECT_LT(table.out.find("\nmatch "), table.out.find("\ntotal "));

  const test::Outcome outcome = test::run_landfix({"latency", whole.string(), "--json"});
  const auto stages = nlohmann::json::parse(outcome.out)["stages"];
  EXPECT_EQ(stages["total"]["count"], 10'000);
  EXPECT_EQ(stages["total"]["met"], true);
  EXPECT_EQ(stages["match"]["met"], nullptr);
  EXPECT_NEAR(stages["total"]["p99_ms"], 1e-6 * static_cast<double>(histogram->percentile_ns(99.0)), 1e-6);
}

TEST(LatencyCommand, JudgesByTheBudgetThatItIsGiven) {
  const test::TemporaryDirectory directory;
  const std::string file = (directory.path() / "other.hgrm").string();
  const std::string budget = (directory.path() / "budget.toml").string();
  std::ofstream(file) << kOfJava << "#[Stage = total]\n";
  std::ofstream(budget) << "[total]\np50_ms = 5.0\nmax_ms = 9\n";
  const test::Outcome outcome = test::run_landfix({"latency", file, "--budget", budget, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto total = nlohmann::json::parse(outcome.out)["stages"]["total"];
  EXPECT_EQ(total["met"], false);
  EXPECT_EQ(total["budget"]["p50_ms"], 5.0);

  std::ofstream(budget) << "[total]\np51_ms = 5.0\n";
  const test::Outcome wrong = test::run_landfix({"latency", file, "--budget", budget});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.error, HasSubstr("budget.toml:2:1: unknown key p51_ms"));
}

TEST(LatencyCommand, SaysWhatAFileIsNot) {
  const test::TemporaryDirectory directory;
  const std::string file = (directory.path() / "poses.tum").string();
  std::ofstream(file) << "1.0 0 0 0 0 0 0 1\n";
  const test::Outcome outcome = test::run_landfix({"latency", file});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("poses.tum:1: expected the title"));
  EXPECT_EQ(test::run_landfix({"latency"}).code, 2);
}

TEST(LatencyBudget, KnowsTheStages) {
  const auto error = error_of([] { return parse_budget("[lunch]\np50_ms = 1.0\n", "b.toml"); });
  EXPECT_THAT(error, HasSubstr("b.toml:1:2: no stage lunch; there are kernel_receive"));
}

}  // namespace
}  // namespace landfix::tools
