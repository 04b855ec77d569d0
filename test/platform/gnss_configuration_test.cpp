#include "platform/gnss_configuration.hpp"

#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/configuration.hpp"
#include "support/error_of.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

constexpr double kRadians_per_deg = std::numbers::pi / 180.0;

GnssSettings parse(const std::string& text) {
  return parse_configuration("[sensor]\nmodel = \"vlp16\"\n" + text, "a.toml").gnss;
}

std::string error_of(const std::string& text) {
  return test::error_of([&] { return parse(text); });
}

std::string signal(const std::string& role, const std::string& more = "") {
  return "[[gnss.signal]]\nrole = \"" + role + "\"\nid = 0x1B0\nstart = 0\nlength = 32\n" + more;
}

TEST(GnssConfiguration, ThereIsNoneByDefault) { EXPECT_EQ(parse("").count, 0U); }

TEST(GnssConfiguration, ReadsAllOfIt) {
  const GnssSettings gnss = parse(
      "[gnss]\nantenna = [0.5, -0.2, 1.5]\naccuracy_m = 5\n" + signal("latitude", "scale = 1e-7\n") +
      signal("longitude", "unit = \"rad\"\n") + signal("altitude") + signal("heading", "timeout_s = 0.5\n"));
  EXPECT_EQ(gnss.antenna_m, Eigen::Vector3d(0.5, -0.2, 1.5));
  EXPECT_EQ(gnss.accuracy_m, 5.0);
  ASSERT_EQ(gnss.count, 4U);
  EXPECT_EQ(gnss.signals[0].role, VehicleRole::latitude);
  EXPECT_NEAR(gnss.signals[0].scale, 1e-7 * kRadians_per_deg, 1e-18);
  EXPECT_NEAR(gnss.signals[0].high, 90.0 * kRadians_per_deg, 1e-12);
  EXPECT_EQ(gnss.signals[1].scale, 1.0);
  EXPECT_EQ(gnss.signals[2].scale, 1.0);
  EXPECT_EQ(gnss.signals[2].timeout_ns, 1'000'000'000);
  EXPECT_EQ(gnss.signals[3].timeout_ns, 500'000'000);
}

TEST(GnssConfiguration, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(signal("latitude")), HasSubstr("both latitude and longitude"));
  EXPECT_THAT(error_of(signal("speed")), HasSubstr("one of latitude, longitude, altitude, heading"));
  EXPECT_THAT(error_of("[[odometry.signal]]\nrole = \"latitude\"\n"), HasSubstr("one of speed, wheel_fl"));
  EXPECT_THAT(error_of(signal("latitude", "unit = \"m\"\n")), HasSubstr("one of deg, rad"));
  EXPECT_THAT(error_of("[gnss]\nantenna = [0.5, 1.5]\n"), HasSubstr("[x, y, z]: three numbers"));
  EXPECT_THAT(error_of("[gnss]\naccuracy_m = 0\n"), HasSubstr("a number from 0.1 to 50"));
  EXPECT_THAT(error_of("[gnss]\ntrack_m = 1\n"), HasSubstr("unknown key track_m"));
}

}  // namespace
}  // namespace landfix::platform
