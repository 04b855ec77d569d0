#include "tools/evaluation_report.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace landfix::tools {
namespace {

TEST(EvaluationReport, KeepsTheKeysThatOthersRelyOn) {
  platform::Evaluation evaluation{.pairs = 3};
  evaluation.ate_m.rmse = 0.25;
  const nlohmann::ordered_json json = to_json(evaluation);
  EXPECT_EQ(json["pairs"], 3);
  EXPECT_EQ(json["ate_m"]["rmse"], 0.25);
  for (const char* key : {"ate_m", "ate_deg"}) {
    for (const char* statistic : {"rmse", "mean", "median", "max"})
      EXPECT_TRUE(json[key].contains(statistic));
  }
  for (const char* key : {"heading_deg", "rpe_m", "rpe_deg", "elevation_m"}) {
    EXPECT_TRUE(json[key].contains("rmse")) << key;
  }
  EXPECT_TRUE(json["elevation_m"].contains("max"));
}

TEST(EvaluationReport, NothingToMeasureIsNullAndADash) {
  platform::Evaluation evaluation;
  evaluation.rpe_m.rmse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(to_json(evaluation).dump(), testing::HasSubstr(R"("rpe_m":{"rmse":null)"));
  EXPECT_THAT(to_table(evaluation), testing::ContainsRegex("relative position \\[m\\] +- "));
}

}  // namespace
}  // namespace landfix::tools
