#include "platform/odometry_configuration.hpp"

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/configuration.hpp"
#include "support/error_of.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

OdometrySettings parse(const std::string& text, const std::filesystem::path& path = "a.toml") {
  return parse_configuration("[sensor]\nmodel = \"vlp16\"\n" + text, path).odometry;
}

std::string error_of(const std::string& text) {
  return test::error_of([&] { return parse(text); });
}

const std::string kSignal = "[[odometry.signal]]\nrole = \"speed\"\nid = 0x1A0\nstart = 6\nlength = 15\n";

TEST(OdometryConfiguration, ThereIsNoneByDefault) { EXPECT_EQ(parse("").count, 0U); }

TEST(OdometryConfiguration, ReadsASignal) {
  const OdometrySettings settings =
      parse("[odometry]\ntrack_m = 1.6\n" + kSignal +
            "order = \"motorola\"\nsigned = true\nscale = 0.01\noffset = -67.67\nunit = \"km/h\"\n"
            "sign_bit = 23\nvalid_bit = 24\nvalid_value = false\ninvalid_raw = [0x7FFF, 1]\nmin = -5.0\n"
            "max = 60\ntimeout_s = 0.5\n[[odometry.signal]]\nrole = \"reverse\"\nid = 0x18FEF1D5\n"
            "extended = true\nstart = 3\nlength = 1\n");
  ASSERT_EQ(settings.count, 2U);
  EXPECT_EQ(settings.track_m, 1.6);
  const VehicleSignal& speed = settings.signals[0];
  EXPECT_EQ(speed.role, VehicleRole::speed);
  EXPECT_EQ(speed.id, 0x1A0U);
  EXPECT_EQ(speed.field.start, 6U);
  EXPECT_EQ(speed.field.length, 15U);
  EXPECT_TRUE(speed.field.motorola);
  EXPECT_TRUE(speed.field.is_signed);
  EXPECT_NEAR(speed.scale, 0.01 / 3.6, 1e-12);
  EXPECT_NEAR(speed.offset, -67.67 / 3.6, 1e-12);
  EXPECT_EQ(speed.sign_bit, 23);
  EXPECT_EQ(speed.valid_bit, 24);
  EXPECT_FALSE(speed.valid_value);
  EXPECT_EQ(speed.invalid_count, 2U);
  EXPECT_EQ(speed.invalid_raw[0], 0x7FFFU);
  EXPECT_EQ(speed.low, -5.0);
  EXPECT_EQ(speed.high, 60.0);
  EXPECT_EQ(speed.timeout_ns, 500'000'000);
  EXPECT_TRUE(settings.signals[1].extended);
  EXPECT_EQ(settings.signals[1].timeout_ns, 1'000'000'000);
}

TEST(OdometryConfiguration, ReadsASignalOfADbcFile) {
  const test::TemporaryDirectory folder;
  std::ofstream(folder.path() / "car.dbc")
      << "BO_ 170 ESP: 8 X\n SG_ YAW : 7|16@0- (0.01,0.5) [-3|3] \"deg/s\" X\n SG_ OLD m1 : 0|8@1+ (1,0) "
         "[0|1] \"\" X\n SG_ ODD : 0|8@1+ (1,0) [0|1] \"furlong\" X\n";
  const auto parse_yaw = [&](const std::string& name) {
    return parse(fmt::format("[odometry]\ndbc = \"car.dbc\"\n[[odometry.signal]]\nrole = \"yaw_rate\"\n"
                             "signal = \"{}\"\n",
                             name),
                 folder.path() / "a.toml");
  };
  const OdometrySettings settings = parse_yaw("ESP.YAW");
  ASSERT_EQ(settings.count, 1U);
  EXPECT_EQ(settings.signals[0].id, 170U);
  EXPECT_EQ(settings.signals[0].field.start, 7U);
  EXPECT_NEAR(settings.signals[0].scale, 0.01 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_THAT(test::error_of([&] { return parse_yaw("ESP.YAWN"); }),
              HasSubstr("\"MESSAGE.SIGNAL\" of the file"));
  EXPECT_THAT(test::error_of([&] { return parse_yaw("ESP.OLD"); }), HasSubstr("not multiplexed"));
  EXPECT_THAT(test::error_of([&] { return parse_yaw("ESP.ODD"); }), HasSubstr("the DBC says \"furlong\""));
}

TEST(OdometryConfiguration, SaysWhatIsWrong) {
  EXPECT_THAT(error_of("[[odometry.signal]]\nid = 1\n"), HasSubstr("role is missing"));
  EXPECT_THAT(error_of("[[odometry.signal]]\nrole = \"speed\"\n"), HasSubstr("id is missing"));
  EXPECT_THAT(error_of("[[odometry.signal]]\nrole = \"gear\"\n"), HasSubstr("one of speed, wheel_fl"));
  EXPECT_THAT(error_of(kSignal + "bits = 3\n"), HasSubstr("unknown key bits; [odometry.signal] has role"));
  EXPECT_THAT(error_of(kSignal + "unit = \"deg/s\"\n"), HasSubstr("one of m/s, km/h, mph"));
  EXPECT_THAT(error_of(kSignal + kSignal), HasSubstr("each role at most once"));
  EXPECT_THAT(error_of(kSignal + "invalid_raw = [1, 2, 3, 4, 5]\n"), HasSubstr("a list of at most 4"));
  EXPECT_THAT(error_of(kSignal + "scale = 0\n"), HasSubstr("expected not 0"));
  EXPECT_THAT(error_of("[odometry]\nsignal = 1\n"), HasSubstr("tables, each [[odometry.signal]]"));
  EXPECT_THAT(error_of("[odometry]\ndbc = \"missing.dbc\"\n"), HasSubstr("missing.dbc"));
}

}  // namespace
}  // namespace landfix::platform
