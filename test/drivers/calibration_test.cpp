#include "drivers/hesai/calibration.hpp"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/make_decoder.hpp"

namespace landfix::drivers::hesai {
namespace {

using testing::HasSubstr;

constexpr Beam kTable[] = {{.ring = 2, .elevation_deg = 10.0, .firing_time_us = -3.0},
                           {.ring = 1, .elevation_deg = 0.0, .firing_time_us = -2.0},
                           {.ring = 0, .elevation_deg = -10.0, .firing_time_us = -1.0}};

std::vector<Beam> parse(std::string_view text) {
  return parse_calibration(std::as_bytes(std::span(text)), "unit.csv", kTable);
}

std::string error_of(std::string_view text) {
  try {
    static_cast<void>(parse(text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(HesaiCalibration, ReadsAnglesAndKeepsFiringTimes) {
  const auto beams = parse("Laser id,Elevation,Azimuth\n1,1.5,-1.042\n2,3.25,0\n3,-7,+2.5e0\n");
  ASSERT_EQ(beams.size(), 3U);
  EXPECT_EQ(beams[0].elevation_deg, 1.5);
  EXPECT_EQ(beams[0].azimuth_offset_deg, -1.042);
  EXPECT_EQ(beams[1].firing_time_us, -2.0);
  EXPECT_EQ(beams[0].ring, 1) << "ranked by the unit's own elevations";
  EXPECT_EQ(beams[1].ring, 2);
  EXPECT_EQ(beams[2].ring, 0);
}

TEST(HesaiCalibration, AllowsWhatUnitsSend) {
  const char* const texts[] = {
      "\xEF\xBB\xBFLaser id,Elevation,Azimuth\r\n1,1,0\r\n2,2,0\r\n3,3,0\r\n",  // byte order mark, CRLF
      "EEFF,1,1\nChannel,Elevation,Azimuth\n1,1,0\n2,2,0\n3,3,0",               // two headers, no end of line
      " 1 , 1 ,\t0\n2,2,0\n3,3,0\n\n8a0e1f2b3c\n",                              // blanks, a trailing hash
      "3,3,0\n1,1,0\n2,2,0\n",                                                  // any order
  };
  for (const char* const text : texts) {
    EXPECT_EQ(error_of(text), "no error") << text;
  }
}

TEST(HesaiCalibration, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(error_of(""), HasSubstr("unit.csv:0: channel 1 of 3 is missing"));
  EXPECT_THAT(error_of("h\n1,1,0\n3,3,0\n"), HasSubstr("unit.csv:3: channel 2 of 3 is missing"));
  EXPECT_THAT(error_of("1,1,0\n2,2,0\n2,2,0\n3,3,0\n"), HasSubstr("unit.csv:3: channel 2 is given twice"));
  EXPECT_THAT(error_of("1,1,0\n2,2,0\n3,3,0\n4,4,0\n"),
              HasSubstr("unit.csv:4: channel is not one of 1 to 3"));
  EXPECT_THAT(error_of("0,1,0\n"), HasSubstr("unit.csv:1: channel is not one of 1 to 3"));
  EXPECT_THAT(error_of("1.5,1,0\n"), HasSubstr("unit.csv:1: channel is not one of 1 to 3"));
  EXPECT_THAT(error_of("1,91,0\n"), HasSubstr("unit.csv:1: angle is beyond 90 degrees"));
  EXPECT_THAT(error_of("1,nan,0\n2,2,0\n3,3,0\n"), HasSubstr("channel 1 of 3 is missing"));
  EXPECT_THAT(error_of("1,1,0,0\n2,2,0\n3,3,0\n"), HasSubstr("channel 1 of 3 is missing"));
}

TEST(MakeDecoder, RefusesAnotherModelsCalibrationAndSenselessOptions) {
  const SensorModel& pandar64 = *find_sensor_model("pandar64");
  EXPECT_THROW(
      static_cast<void>(make_decoder(pandar64, {}, std::vector<Beam>(std::begin(kTable), std::end(kTable)))),
      std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.min_range_m = 3.0, .max_range_m = 2.0})),
               std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.cut_deg = NAN})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.min_range_m = NAN})), std::runtime_error);
}

}  // namespace
}  // namespace landfix::drivers::hesai
