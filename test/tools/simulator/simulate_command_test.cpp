#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "support/test_route.hpp"

namespace landfix::tools {
namespace {

using ::testing::HasSubstr;

using test::Outcome;

Outcome simulate(std::vector<std::string> words) {
  words.insert(words.begin(), "simulate");
  return test::run_landfix(words);
}

class SimulateCommand : public ::testing::Test {
 protected:
  SimulateCommand() { std::ofstream(route_) << test::kStreetRoute; }

  const test::TemporaryDirectory folder_;
  const std::string route_ = (folder_.path() / "route.toml").string();
  const std::string output_ = (folder_.path() / "out").string();
};

TEST_F(SimulateCommand, AnUnknownSensorIsRefusedWithThoseThereAre) {
  const Outcome outcome = simulate({"--route", "A", "--sensor", "hdl99", "--output", output_});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.error, HasSubstr("no sensor 'hdl99'; there are "));
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(SimulateCommand, AnUnknownRouteOrAWrongLengthIsRefused) {
  const Outcome route = simulate({"--route", "Z", "--sensor", "vlp16", "--output", output_});
  EXPECT_EQ(route.code, 2);
  EXPECT_THAT(route.error, HasSubstr("no route 'Z'"));
  const Outcome length =
      simulate({"--route", "A", "--sensor", "vlp16", "--output", output_, "--length", "5000"});
  EXPECT_EQ(length.code, 2);
  EXPECT_THAT(length.error, HasSubstr("20 m to 749 m"));
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(SimulateCommand, AWrongRouteFileIsNamedWithItsLine) {
  std::ofstream(route_) << "[road]\nlanes = 2.5\n";
  const Outcome outcome = simulate({"--route", route_, "--sensor", "vlp16", "--output", output_});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("route.toml:2:9: lanes must be"));
}

TEST_F(SimulateCommand, SaysWhatItWroteAsOneObject) {
  const Outcome outcome = simulate({"--route", route_, "--sensor", "vlp16", "--output", output_, "--length",
                                    "22", "--seed", "77", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["seed"], 77);
  EXPECT_EQ(json["length_m"], 22.0);
  EXPECT_GT(json["packets"]["data"], 1000);
  EXPECT_GT(json["map_points"], 10'000);
  EXPECT_EQ(outcome.error, "");  // progress is for terminals
  for (const char* const file : {"capture.pcap", "truth.tum", "map.pcd", "config.toml"}) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(output_) / file)) << file;
  }
}

}  // namespace
}  // namespace landfix::tools
