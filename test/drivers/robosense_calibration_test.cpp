#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/calibration.hpp"
#include "drivers/make_decoder.hpp"
#include "drivers/robosense/calibration.hpp"
#include "support/error_of.hpp"

namespace landfix::drivers::robosense {
namespace {

using testing::HasSubstr;

std::vector<Beam> parse(std::string_view text) {
  return parse_calibration(std::as_bytes(std::span(text)), "angle.csv", 3);
}

std::string error_of(std::string_view text) {
  return test::error_of([&] { return parse(text); });
}

TEST(RobosenseCalibration, ReadsALineALaserAndRanksTheRings) {
  const auto beams = parse("\xEF\xBB\xBF-10.281,8\r\n\r\n +2.333 , -2.672\r\n-25,0\r\n");
  ASSERT_EQ(beams.size(), 3U);
  EXPECT_EQ(beams[0].elevation_deg, -10.281);
  EXPECT_EQ(beams[0].azimuth_offset_deg, 8.0);
  EXPECT_EQ(beams[0].ring, 1);
  EXPECT_EQ(beams[1].elevation_deg, 2.333);
  EXPECT_EQ(beams[1].azimuth_offset_deg, -2.672);
  EXPECT_EQ(beams[1].ring, 2);
  EXPECT_EQ(beams[2].ring, 0);
}

TEST(RobosenseCalibration, NamesTheLineThatIsWrong) {
  EXPECT_THAT(error_of("1,2\n3\n"), HasSubstr("angle.csv:2: not two numbers"));
  EXPECT_THAT(error_of("1,2\n3,4,5\n"), HasSubstr("angle.csv:2: not two numbers"));
  EXPECT_THAT(error_of("a,b\n"), HasSubstr("angle.csv:1: not two numbers"));
  EXPECT_THAT(error_of("1,nan\n"), HasSubstr("angle.csv:1: not two numbers"));
  EXPECT_THAT(error_of("1,2\n90.1,0\n"), HasSubstr("angle.csv:2: angle is beyond 90"));
  EXPECT_THAT(error_of("1,2\n3,4\n"), HasSubstr("angle.csv:2: ends after 2 of 3"));
  EXPECT_THAT(error_of("1,2\n3,4\n5,6\n7,8\n"), HasSubstr("angle.csv:4: more than 3"));
  EXPECT_THAT(error_of(""), HasSubstr("ends after 0 of 3"));
}

TEST(RobosenseCalibration, IsReadForEachModel) {
  for (const auto& [name, lasers] : {std::pair{"rs32", 32U}, {"rs16", 16U}, {"helios16p", 16U}}) {
    const SensorModel& model = *find_sensor_model(name);
    EXPECT_EQ(model.calibration, CalibrationUse::in_stream);
    std::string text;
    for (unsigned i = 0; i < lasers; ++i) text += std::to_string(i) + ",0\n";
    const auto calibration = parse_calibration(model, std::as_bytes(std::span(text)), "angle.csv");
    EXPECT_EQ(std::get<std::vector<Beam>>(calibration).size(), lasers);
    EXPECT_NO_THROW(static_cast<void>(make_decoder(model, {}, calibration)));
    EXPECT_THROW(static_cast<void>(make_decoder(model, {}, std::vector<Beam>(8))), std::runtime_error);
  }
}

TEST(RobosenseCalibration, TheRangeUnitIsForTheOneModelThatHasHadTwo) {
  EXPECT_NO_THROW(static_cast<void>(make_decoder(*find_sensor_model("rs32"), {.range_unit_m = 0.01})));
  EXPECT_NO_THROW(static_cast<void>(make_decoder(*find_sensor_model("rs32"), {.range_unit_m = 0.005})));
  EXPECT_THROW(static_cast<void>(make_decoder(*find_sensor_model("rs32"), {.range_unit_m = 0.002})),
               std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(*find_sensor_model("rs16"), {.range_unit_m = 0.01})),
               std::runtime_error);
}

}  // namespace
}  // namespace landfix::drivers::robosense
