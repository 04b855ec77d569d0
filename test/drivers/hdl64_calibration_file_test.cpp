#include "drivers/velodyne/hdl64_calibration_file.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/hdl64_calibration_text.hpp"

namespace landfix::drivers::velodyne {
namespace {

using test::kHdl64XmlEnd;
using test::xml_array;
using test::xml_points;
using test::yaml_lasers;
using testing::HasSubstr;

Hdl64Calibration parse(std::string_view text) {
  return parse_hdl64_calibration(std::as_bytes(std::span(text)), "unit");
}

std::string error_of(std::string_view text) {
  return test::error_of([&] { return parse(text); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument("not there: " + from);
  return text.replace(at, from.size(), to);
}

TEST(Hdl64DbXml, ReadsDegreesAndCentimetres) {
  std::vector<int> enabled(64, 1);
  enabled[7] = 0;
  const auto calibration =
      parse("\xEF\xBB\xBF<?xml version=\"1.0\" ?>\r\n<!DOCTYPE boost_serialization>\n" + xml_points() +
            xml_array("enabled_", enabled) + xml_array("minIntensity_", std::vector<int>(64, 20)) +
            xml_array("maxIntensity_", std::vector<int>(64, 240)) + kHdl64XmlEnd);
  const Hdl64Laser& laser = calibration.lasers[3];
  EXPECT_DOUBLE_EQ(laser.rotation_deg, -1.5);
  EXPECT_DOUBLE_EQ(laser.elevation_deg, -3.25);
  EXPECT_DOUBLE_EQ(laser.range_m, 1.25);
  EXPECT_DOUBLE_EQ(laser.range_x_m, 1.315);
  EXPECT_DOUBLE_EQ(laser.range_y_m, 1.28);
  EXPECT_DOUBLE_EQ(laser.vertical_offset_m, 0.205);
  EXPECT_DOUBLE_EQ(laser.horizontal_offset_m, -0.026);
  EXPECT_DOUBLE_EQ(laser.focal_distance_m, 10.5);
  EXPECT_DOUBLE_EQ(laser.focal_slope, 1.85);
  EXPECT_EQ(laser.min_intensity, 20);
  EXPECT_EQ(laser.max_intensity, 240);
  EXPECT_TRUE(laser.enabled);
  EXPECT_FALSE(calibration.lasers[7].enabled);
  EXPECT_FALSE(calibration.intensity_is_corrected);
}

TEST(Hdl64DbXml, DoesWithoutWhatOldFilesLack) {
  const auto calibration = parse(xml_points() + kHdl64XmlEnd);
  EXPECT_TRUE(calibration.lasers[63].enabled);
  EXPECT_EQ(calibration.lasers[63].max_intensity, 255);
  std::string old = xml_points() + kHdl64XmlEnd;
  for (const char* const element :
       {"<distCorrectionX_>131.5</distCorrectionX_>", "<distCorrectionY_>128</distCorrectionY_>",
        "<focalDistance_>1050</focalDistance_><focalSlope_>1.85</focalSlope_>"}) {
    old = replaced(old, element, "");
  }
  const auto of_old = parse(old);
  EXPECT_DOUBLE_EQ(of_old.lasers[0].range_x_m, 1.25) << "the far correction does for all distances";
  EXPECT_DOUBLE_EQ(of_old.lasers[0].focal_slope, 0.0);
  std::vector<int> all_but_the_last(64, 1);
  all_but_the_last[63] = 0;
  const auto without = parse(xml_points(63) + xml_array("enabled_", all_but_the_last) + kHdl64XmlEnd);
  EXPECT_FALSE(without.lasers[63].enabled);
}

TEST(Hdl64DbXml, SaysWhatIsWrongAndWhere) {
  const std::string sound = xml_points() + kHdl64XmlEnd;
  const auto with = [&sound](const std::string& from, const std::string& to) {
    return error_of(replaced(sound, from, to));
  };
  EXPECT_EQ(error_of(sound), "no error");
  EXPECT_THAT(error_of(""), HasSubstr("unit:1: is empty"));
  EXPECT_THAT(error_of("<DB>\n"), HasSubstr("not XML"));
  EXPECT_THAT(error_of("<DB>\n<a></b></DB>"), HasSubstr("unit:2: not XML"));
  EXPECT_THAT(error_of("<DB></DB>"), HasSubstr("unit:1: no <boost_serialization>"));
  EXPECT_THAT(error_of("<boost_serialization><DB/></boost_serialization>"), HasSubstr("no <points_>"));
  EXPECT_THAT(with(">0.2<", ">0.4<"), HasSubstr("unit:2: <distLSB_> is not 0.2: the file is another"));
  EXPECT_THAT(with("<id_>3<", "<id_>64<"), HasSubstr("unit:37: <id_> is not one of 0 to 63"));
  EXPECT_THAT(with("<id_>3<", "<id_>2<"), HasSubstr("unit:37: laser 2 is given twice"));
  EXPECT_THAT(with(">-3.25<", ">x<"), HasSubstr("unit:40: vertCorrection_ is not a number: 'x'"));
  EXPECT_THAT(with(">-3.25<", ">nan<"), HasSubstr("unit:40: vertCorrection_ is not a number"));
  EXPECT_THAT(with(">-3.25<", ">-93.25<"), HasSubstr("unit:37: laser 3 has an angle beyond 90"));
  EXPECT_THAT(with("<vertCorrection_>-3.25</vertCorrection_>", ""),
              HasSubstr("unit:37: a laser without <vertCorrection_>"));
  EXPECT_THAT(error_of(xml_points(63) + kHdl64XmlEnd), HasSubstr("unit:3: laser 63 of 64 is missing"));
  EXPECT_THAT(error_of(xml_points() + xml_array("enabled_", std::vector<int>(65, 1)) + kHdl64XmlEnd),
              HasSubstr("<enabled_> has more than 64 items"));
  EXPECT_THAT(error_of(xml_points() + xml_array("minIntensity_", {256}) + kHdl64XmlEnd),
              HasSubstr("0 to 255"));
  EXPECT_THAT(error_of(xml_points() + xml_array("minIntensity_", {9}) + xml_array("maxIntensity_", {8}) +
                       kHdl64XmlEnd),
              HasSubstr("laser 0 has a least intensity above its greatest"));
  EXPECT_THAT(error_of(std::string((1 << 20) + 1, '<')), HasSubstr("longer than any calibration"));
}

TEST(Hdl64Yaml, ReadsRadiansAndMetres) {
  const auto calibration = parse("distance_resolution: 0.002\n" + yaml_lasers() + "num_lasers: 64\n");
  const Hdl64Laser& laser = calibration.lasers[3];
  EXPECT_NEAR(laser.rotation_deg, -1.432394488, 1e-9);
  EXPECT_NEAR(laser.elevation_deg, -0.171887339, 1e-9);
  EXPECT_DOUBLE_EQ(laser.range_m, 1.25);
  EXPECT_DOUBLE_EQ(laser.range_x_m, 1.315);
  EXPECT_DOUBLE_EQ(laser.range_y_m, 1.28);
  EXPECT_DOUBLE_EQ(laser.vertical_offset_m, 0.205);
  EXPECT_DOUBLE_EQ(laser.horizontal_offset_m, -0.026);
  EXPECT_DOUBLE_EQ(laser.focal_distance_m, 10.5);
  EXPECT_DOUBLE_EQ(laser.focal_slope, 1.85);
  EXPECT_EQ(laser.min_intensity, 20);
  EXPECT_EQ(laser.max_intensity, 255) << "left out where it is the most there is";
}

TEST(Hdl64Yaml, TakesTheTwoPointValuesUnlessTheFileSaysThatTheyAreNone) {
  const std::string flag = "  two_pt_correction_available: true\n";
  EXPECT_DOUBLE_EQ(parse(replaced(yaml_lasers(), flag, "")).lasers[0].range_x_m, 1.315);
  EXPECT_DOUBLE_EQ(parse(replaced(yaml_lasers(), "available: true", "available: false")).lasers[0].range_x_m,
                   1.25);
}

TEST(Hdl64Yaml, ReadsLasersWrittenInOneLineAndThoseThatAreOff) {
  std::string text = "lasers:\n";
  for (int i = 0; i < 62; ++i) {
    text += "- {laser_id: " + std::to_string(i) +
            ", rot_correction: 0.1, vert_correction: 1e-2, dist_correction: 1.3}\n";
  }
  const auto calibration = parse(text + "num_lasers: 62\n");
  EXPECT_TRUE(calibration.lasers[61].enabled);
  EXPECT_FALSE(calibration.lasers[62].enabled);
  EXPECT_DOUBLE_EQ(calibration.lasers[0].range_y_m, 1.3);
  EXPECT_THAT(error_of(text), HasSubstr("unit:2: laser 62 of 64 is missing, and no num_lasers"));
  EXPECT_THAT(error_of(text + "num_lasers: 64\n"), HasSubstr("unit:64: num_lasers does not count"));
}

TEST(Hdl64Yaml, SaysWhatIsWrongAndWhere) {
  const std::string sound = yaml_lasers();
  const auto with = [&sound](const std::string& from, const std::string& to) {
    return error_of(replaced(sound, from, to));
  };
  EXPECT_EQ(error_of(sound), "no error");
  EXPECT_THAT(error_of("text"), HasSubstr("unit:1: no keys"));
  EXPECT_THAT(error_of("a: 1\n"), HasSubstr("unit:1: no list `lasers`"));
  EXPECT_THAT(error_of("lasers: []\nnum_lasers: 0\n"), HasSubstr("laser 0 of 64 is missing"));
  EXPECT_THAT(error_of("lasers:\n- 1\n"), HasSubstr("unit:2: an entry of `lasers`"));
  EXPECT_THAT(error_of("lasers: [\n"), HasSubstr("not YAML as expected"));
  EXPECT_THAT(error_of("a: 1\nb: *c\n"), HasSubstr("unit:2: not YAML as expected"));
  EXPECT_THAT(error_of("distance_resolution: 0.004\n" + sound), HasSubstr("unit:1: distance_resolution"));
  EXPECT_THAT(with("laser_id: 3\n", "laser_id: 64\n"), HasSubstr("unit:38: laser_id is not one of 0 to 63"));
  EXPECT_THAT(with("laser_id: 3\n", "laser_id: 2\n"), HasSubstr("unit:38: laser 2 is given twice"));
  EXPECT_THAT(with("vert_correction: -0.003", "vert_correction: down"),
              HasSubstr("unit:48: vert_correction"));
  EXPECT_THAT(with("vert_correction: -0.003", "vert_correction: [1]"), HasSubstr("is not one value"));
  EXPECT_THAT(with("vert_correction: -0.003", "vert_correction: -8.7"), HasSubstr("units"));
  EXPECT_THAT(with("  vert_correction: -0.003\n", ""), HasSubstr("unit:38: a laser without vert_correction"));
  EXPECT_THAT(with("available: true", "available: perhaps"), HasSubstr("unit:11: not YAML as expected"));
  EXPECT_THAT(with("min_intensity: 20", "min_intensity: -1"), HasSubstr("unit:9: min_intensity is not one"));
  EXPECT_THAT(error_of(std::string(10'000, '[')), HasSubstr("more lists and maps"));
  std::string deep;
  for (int i = 0; i < 10'000; ++i) deep += "- ";
  EXPECT_THAT(error_of(deep), HasSubstr("not YAML as expected"));
}

}  // namespace
}  // namespace landfix::drivers::velodyne
