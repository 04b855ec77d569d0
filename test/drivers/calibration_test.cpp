#include "drivers/hesai/calibration.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/make_decoder.hpp"
#include "support/error_of.hpp"

namespace landfix::drivers::hesai {
namespace {

using testing::HasSubstr;

constexpr Beam kTable[] = {{.ring = 2, .elevation_deg = 2.0, .firing_time_us = -3.0},
                           {.ring = 1, .elevation_deg = 0.0, .firing_time_us = -2.0},
                           {.ring = 0, .elevation_deg = -2.0, .firing_time_us = -1.0}};

std::vector<Beam> parse(std::string_view text) {
  return parse_calibration(std::as_bytes(std::span(text)), "unit.csv", kTable);
}

std::string error_of(std::string_view text) {
  return test::error_of([&] { return parse(text); });
}

TEST(HesaiCalibration, ReadsAnglesAndKeepsFiringTimes) {
  const auto beams = parse("Laser id,Elevation,Azimuth\n1,1.5,-1.042\n2,3.25,0\n3,-3,+2.5e0\n");
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
  EXPECT_THAT(error_of("1,1,0\n2,5.01,0\n"), HasSubstr("unit.csv:2: channel 2 points more than 5 degrees"));
  EXPECT_THAT(error_of("1,1,-5.01\n"), HasSubstr("unit.csv:1: channel 1 points more than 5 degrees"));
  EXPECT_THAT(error_of("Channel,fire time(us)\n1,-23.18\n2,-21.876\n3,-20.572\n"),
              HasSubstr("channel 1 of 3 is missing, expected a line channel,elevation,azimuth"));
  EXPECT_THAT(error_of("1,nan,0\n2,2,0\n3,3,0\n"), HasSubstr("channel 1 of 3 is missing"));
  EXPECT_THAT(error_of("1,1,0,0\n2,2,0\n3,3,0\n"), HasSubstr("channel 1 of 3 is missing"));
}

/// What a unit of the model would send.
std::string file_of(const SensorModel& model, double lower_deg) {
  std::string text = "Laser id,Elevation,Azimuth\n";
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    text += std::to_string(i + 1) + "," + std::to_string(model.beams[i].elevation_deg - lower_deg) + "," +
            std::to_string(model.beams[i].azimuth_offset_deg) + "\r\n";
  }
  return text;
}

TEST(HesaiCalibration, ServesEveryModelAndKnowsThemApart) {
  const SensorModel& pandar64 = *find_sensor_model("pandar64");
  const SensorModel& pandar40p = *find_sensor_model("pandar40p");
  const auto read = [](const SensorModel& model, const std::string& text) {
    return std::get<std::vector<Beam>>(
        drivers::parse_calibration(model, std::as_bytes(std::span(text)), "unit.csv"));
  };
  for (const SensorModel* const model : {&pandar64, &pandar40p}) {
    // The makers' own defaults are up to 0.42 deg apart.
    const auto beams = read(*model, file_of(*model, 0.42));
    ASSERT_EQ(beams.size(), model->beam_count);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      EXPECT_NEAR(beams[i].elevation_deg, model->beams[i].elevation_deg - 0.42, 1e-6);
      EXPECT_EQ(beams[i].firing_time_us, model->beams[i].firing_time_us);
      EXPECT_EQ(beams[i].ring, model->beams[i].ring);
    }
    EXPECT_NO_THROW(static_cast<void>(make_decoder(*model, {}, beams)));
  }
  EXPECT_THROW(static_cast<void>(read(pandar64, file_of(pandar40p, 0.0))), std::runtime_error);
  EXPECT_THROW(static_cast<void>(read(pandar40p, file_of(pandar64, 0.0))), std::runtime_error);
  // A PandarQT64 has 64 channels too, the first of them 52 deg below.
  std::string qt64;
  for (int i = 0; i < 64; ++i) {
    qt64 += std::to_string(i + 1) + "," + std::to_string(-52.121 + 1.654 * i) + ",8.736\n";
  }
  EXPECT_THROW(static_cast<void>(read(pandar64, qt64)), std::runtime_error);
}

/// A calibration of each kind, as large as the model.
std::vector<Calibration> one_of_each_kind(const SensorModel& model) {
  ouster::Metadata metadata;
  metadata.beam_count = model.beam_count;
  return {Calibration{}, std::vector<Beam>(model.beam_count), velodyne::Hdl64Calibration{}, metadata};
}

/// Those that the sensor's documents know.
bool is_of_kind(const SensorModel& model, const Calibration& calibration) {
  if (std::holds_alternative<std::monostate>(calibration))
    return model.calibration != CalibrationUse::required;
  if (std::holds_alternative<ouster::Metadata>(calibration)) return model.vendor == "Ouster";
  if (std::holds_alternative<velodyne::Hdl64Calibration>(calibration)) return model.name.starts_with("hdl64");
  return model.vendor == "Hesai" || model.vendor == "RoboSense" || model.name.starts_with("vls128");
}

TEST(MakeDecoder, TakesTheKindOfCalibrationThatASensorHasAndNoOther) {
  for (const SensorModel& model : sensor_models()) {
    for (const Calibration& calibration : one_of_each_kind(model)) {
      const auto make = [&] { static_cast<void>(make_decoder(model, {}, calibration)); };
      if (is_of_kind(model, calibration)) {
        EXPECT_NO_THROW(make()) << model.name << ", kind " << calibration.index();
      } else {
        EXPECT_THROW(make(), std::runtime_error) << model.name << ", kind " << calibration.index();
      }
    }
  }
}

TEST(MakeDecoder, RefusesAsManyBeamsAsAnotherModelHas) {
  for (const SensorModel& model : sensor_models()) {
    for (const Calibration& calibration : one_of_each_kind(model)) {
      if (!is_of_kind(model, calibration)) continue;
      Calibration larger = calibration;
      if (auto* const beams = std::get_if<std::vector<Beam>>(&larger))
        beams->emplace_back();
      else if (auto* const metadata = std::get_if<ouster::Metadata>(&larger))
        ++metadata->beam_count;
      else
        continue;
      EXPECT_THROW(static_cast<void>(make_decoder(model, {}, larger)), std::runtime_error) << model.name;
    }
  }
}

TEST(MakeDecoder, RefusesAnotherModelsCalibrationAndSenselessOptions) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const SensorModel& pandar64 = *find_sensor_model("pandar64");
  EXPECT_THROW(
      static_cast<void>(make_decoder(pandar64, {}, std::vector<Beam>(std::begin(kTable), std::end(kTable)))),
      std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.min_range_m = 3.0, .max_range_m = 2.0})),
               std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.cut_deg = kNan})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(make_decoder(pandar64, {.min_range_m = kNan})), std::runtime_error);
}

}  // namespace
}  // namespace landfix::drivers::hesai
