#include "tools/simulator/route.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_data.hpp"
#include "support/test_route.hpp"
#include "tools/simulator/path.hpp"

namespace landfix::tools::simulator {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string with(std::string toml, const std::string& line, const std::string& replacement) {
  return toml.replace(toml.find(line), line.size(), replacement);
}

TEST(Route, NamedRoutesHaveTheLengthsAndSpeedsTheyAreKnownBy) {
  EXPECT_DOUBLE_EQ(load_route("A").length_m(), 749.0);
  EXPECT_DOUBLE_EQ(load_route("B").length_m(), 475.0);
  EXPECT_DOUBLE_EQ(load_route("C").length_m(), 797.0);
  EXPECT_DOUBLE_EQ(load_route("street").length_m(), 300.0);
  EXPECT_DOUBLE_EQ(load_route("tunnel").length_m(), 400.0);
  EXPECT_DOUBLE_EQ(load_route("field").length_m(), 300.0);
  EXPECT_DOUBLE_EQ(load_route("city").length_m(), 1347.0);
  EXPECT_EQ(load_route("B").road.lanes, 4);
}

TEST(Route, TheHillyRouteHasItsAverageSlope) {
  const Route route = load_route("C");
  const Path path(route);
  double climbed_m = 0.0;
  for (double s = 0.0; s < route.length_m(); s += 0.5)
    climbed_m += std::abs(std::tan(path.at(s).slope_rad)) * 0.5;
  EXPECT_NEAR(climbed_m / route.length_m(), 0.076, 0.001);
}

TEST(Route, TheStreetHasAHillOfSeveralMetres) {
  const Path path(load_route("street"));
  double highest_m = 0.0;
  for (double s = 0.0; s < path.length_m(); s += 1.0)
    highest_m = std::max(highest_m, path.at(s).position_m.z());
  EXPECT_GT(highest_m, 3.0);
}

TEST(Route, MistakesAreNamedWithLineAndColumn) {
  using test::kStreetRoute;
  const auto parsing = [](const std::string& toml) { return [toml] { (void)parse_route(toml, "my.toml"); }; };
  EXPECT_THAT(parsing(with(kStreetRoute, "lanes = 2", "lanse = 2")),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:5:1: unknown key 'lanse'")));
  EXPECT_THAT(parsing(with(kStreetRoute, "lanes = 2", "lanes = 3")),
              ThrowsMessage<std::runtime_error>(HasSubstr("lanes must be 1 or even")));
  EXPECT_THAT(parsing(with(kStreetRoute, "lanes = 2", "lanes = \"2\"")),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:5:9: lanes must be a whole number")));
  EXPECT_THAT(parsing(with(kStreetRoute, "grade = 0.06", "grade = 6")),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:16:9: grade must be a number")));
  EXPECT_THAT(parsing(with(kStreetRoute, "grade = 0.06", "grade = nan")),
              ThrowsMessage<std::runtime_error>(HasSubstr("grade must be a number")));
  EXPECT_THAT(parsing(with(kStreetRoute, "turn_deg = 20.0", "turn_deg = 170.0")),
              ThrowsMessage<std::runtime_error>(HasSubstr("radius of 5.4 m")));
  EXPECT_THAT(parsing(with(kStreetRoute, "turn_deg = 20.0", "turn_deg = 20.0\ncurvature_1pm = 0.1")),
              ThrowsMessage<std::runtime_error>(HasSubstr("not both")));
  EXPECT_THAT(parsing(with(kStreetRoute, "heading_deg = 30.0", "heading_deg = ")),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:3:")));
  EXPECT_THAT(parsing("[road]\n[scenery]\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("'segment' is missing")));
  EXPECT_THAT(parsing("[road]\n[scenery]\nsegment = 3\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("unknown key 'segment'")));
  EXPECT_THAT(parsing(""), ThrowsMessage<std::runtime_error>(HasSubstr("'road' is missing")));
  EXPECT_THAT(parsing("[road]\n[scenery]\n[[segment]]\nlength_m = 3\nspeed_kmh = 20\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("add up to 3 m")));
}

TEST(Route, MistakesInTheOptionalTablesAreNamedWithLineAndColumn) {
  const auto with_table = [](const std::string& table) {
    return [table] { (void)parse_route("[road]\n[scenery]\n" + table + "\n[[segment]]\n", "my.toml"); };
  };
  EXPECT_THAT(with_table("[land]\nreach_m = -1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:4:11: reach_m must be a number from 0")));
  EXPECT_THAT(with_table("[survey]\nspacing_m = 0.0"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:4:13: spacing_m must be a number")));
  EXPECT_THAT(with_table("[tunnel]\nwall_height = 2.0"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:4:1: unknown key 'wall_height'")));
  EXPECT_THAT(with_table("[tunnel]\nniche_spacing_m = 1.0"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:4:19: niche_spacing_m must be 0 (none)")));
  EXPECT_THAT(with_table("[city]\nwest_m = 0\nsouth_m = 0\ncolumns = 0"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:6:11: columns must be a whole number")));
  EXPECT_THAT(with_table("[city]\nwest_m = 0"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:3:1: 'south_m' is missing here")));
  EXPECT_THAT(
      with_table("[city]\nwest_m = 0\nsouth_m = 0\nrows = 40"),
      ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:3:1: the blocks are 18.5 m long or wide")));
  EXPECT_THAT(with_table("[city]\nwest_m = 0\nsouth_m = 0\n[tunnel]"),
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:3:1: a [city] fills its square")));
}

TEST(Route, ATunnelThatIsNoTableIsNamedWithItsPlace) {
  EXPECT_THAT([] { (void)parse_route("tunnel = 3\n[road]\n[scenery]\n", "my.toml"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("my.toml:1:10: tunnel must be a table")));
}

TEST(Route, IsReadFromAFile) {
  const test::TemporaryDirectory folder;
  const std::string file = (folder.path() / "mine.toml").string();
  std::ofstream(file) << test::kStreetRoute;
  EXPECT_DOUBLE_EQ(load_route(file).length_m(), 28.0);
}

TEST(Route, AnUnknownNameListsTheKnownOnes) {
  EXPECT_THAT([] { (void)load_route("Z"); }, ThrowsMessage<std::invalid_argument>(
                                                 HasSubstr("A, B, C, circuit, city, field, street, tunnel")));
}

TEST(Route, CanBeShortenedButNotStretched) {
  EXPECT_DOUBLE_EQ(shortened(load_route("A"), 200.0).length_m(), 200.0);
  EXPECT_DOUBLE_EQ(shortened(load_route("A"), 749.0).length_m(), 749.0);
  for (const double length_m : {750.0, 5.0, 0.0, -1.0, std::nan("")}) {
    EXPECT_THROW((void)shortened(load_route("A"), length_m), std::invalid_argument) << length_m;
  }
}

TEST(Path, TurnsAndClimbsAsTheSegmentsSay) {
  const Route route = test::route_of(
      "[road]\n[scenery]\n[[segment]]\nlength_m = 60\nspeed_kmh = 30\n"
      "[[segment]]\nlength_m = 50\nturn_deg = 70\nspeed_kmh = 30\n"
      "[[segment]]\nlength_m = 100\ngrade = 0.05\nspeed_kmh = 30\n");
  const Path path(route);
  EXPECT_NEAR(path.at(160.0).heading_rad - path.at(20.0).heading_rad, 70.0 * std::numbers::pi / 180.0, 0.01);
  EXPECT_NEAR(path.at(160.0).slope_rad, std::atan(0.05), 1e-9);
  EXPECT_LT(path.at(0.0).position_m.norm(), 1e-9);
}

TEST(Path, HasNoJumpInPositionHeadingOrSlope) {
  const Path path(load_route("C"));
  constexpr double kStep_m = 0.01;
  for (double s = path.first_station_m(); s + kStep_m < path.last_station_m(); s += kStep_m) {
    const PathPoint a = path.at(s);
    const PathPoint b = path.at(s + kStep_m);
    ASSERT_NEAR((b.position_m - a.position_m).norm(), kStep_m, 1e-6) << s;
    ASSERT_LT(std::abs(b.heading_rad - a.heading_rad), 0.05 * kStep_m) << s;
    ASSERT_LT(std::abs(b.slope_rad - a.slope_rad), 0.015 * kStep_m) << s;
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
