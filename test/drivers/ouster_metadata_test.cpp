#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drivers/calibration.hpp"
#include "drivers/ouster/metadata_file.hpp"
#include "support/error_of.hpp"

namespace landfix::drivers::ouster {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

json angles(std::size_t count, double first, double last) {
  json list = json::array();
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return list;
}

/// Two angle arrays and the mode: what the vendor's tools save at the least.
json reduced(std::size_t rows = 64) {
  return {{"lidar_mode", "512x20"},
          {"beam_altitude_angles", angles(rows, 20.0, -20.0)},
          {"beam_azimuth_angles", angles(rows, 4.0, -4.0)}};
}

/// As the sensor's HTTP interface gives it out.
json nested() {
  json file;
  file["sensor_info"] = {
      {"prod_line", "OS-1-64-AH"}, {"prod_sn", "122201000998"}, {"prod_pn", "840-104710-B"}};
  file["beam_intrinsics"] = {
      {"beam_altitude_angles", angles(64, 21.0, 0.4)},
      {"beam_azimuth_angles", angles(64, 4.0, -4.0)},
      {"lidar_origin_to_beam_origin_mm", 15.806},
      {"beam_to_lidar_transform", {1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  file["lidar_intrinsics"] = {
      {"lidar_to_sensor_transform", {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 38.195, 0, 0, 0, 1}}};
  file["lidar_data_format"] = {{"pixels_per_column", 64},
                               {"columns_per_packet", 16},
                               {"columns_per_frame", 2048},
                               {"column_window", {1800, 300}},
                               {"udp_profile_lidar", "RNG19_RFL8_SIG16_NIR16_DUAL"},
                               {"header_type", "FUSA"},
                               {"fps", 10}};
  file["config_params"] = {{"lidar_mode", "2048x10"}};
  return file;
}

Metadata parse(const json& file, std::string_view model = "os1-64") {
  const std::string text = file.dump();
  return parse_metadata(*find_sensor_model(model), std::as_bytes(std::span(text)), "unit.json");
}

std::string error_of(std::string_view text, std::string_view model = "os1-64") {
  return test::error_of(
      [&] { return parse_metadata(*find_sensor_model(model), std::as_bytes(std::span(text)), "unit.json"); });
}

/// Of a file with one value changed.
std::string error_with(json file, const char* section, const char* key, const json& value) {
  (section == nullptr ? file : file[section])[key] = value;
  return error_of(file.dump(1));
}

TEST(OusterMetadata, ReadsTheNestedLayout) {
  const Metadata metadata = parse(nested());
  EXPECT_EQ(metadata.profile, Profile::dual);
  EXPECT_EQ(metadata.header_type, HeaderType::fusa);
  EXPECT_EQ(metadata.row_count, 64U);
  EXPECT_EQ(metadata.beam_count, 64U);
  EXPECT_EQ(metadata.columns_per_frame, 2048U);
  EXPECT_EQ(metadata.frames_per_s, 10);
  EXPECT_EQ(metadata.window.first, 1800U);
  EXPECT_EQ(metadata.window.last, 300U);
  EXPECT_EQ(metadata.serial_number, 122'201'000'998U);
  EXPECT_EQ(metadata.beam_origin_x_mm, 15.806);
  EXPECT_EQ(metadata.beam_origin_z_mm, 0.0);
  EXPECT_EQ(metadata.lidar_to_sensor[11], 38.195);
  EXPECT_EQ(metadata.rows[0].altitude_deg, 21.0);
  EXPECT_EQ(metadata.rows[0].azimuth_deg, 4.0);
  EXPECT_EQ(metadata.rows[0].ring, 63);
  EXPECT_EQ(metadata.rows[63].ring, 0);
}

TEST(OusterMetadata, ReadsTheFlatLayout) {
  json flat;
  const json file = nested();
  for (const auto& [section, values] : file.items()) {
    if (section == "lidar_data_format") {
      flat["data_format"] = values;
    } else {
      flat.update(values);
    }
  }
  const Metadata a = parse(file);
  const Metadata b = parse(flat);
  EXPECT_EQ(a.profile, b.profile);
  EXPECT_EQ(a.columns_per_frame, b.columns_per_frame);
  EXPECT_EQ(a.window.first, b.window.first);
  EXPECT_EQ(a.serial_number, b.serial_number);
  EXPECT_EQ(a.lidar_to_sensor, b.lidar_to_sensor);
  EXPECT_EQ(a.beam_origin_x_mm, b.beam_origin_x_mm);
  EXPECT_EQ(a.rows[17].altitude_deg, b.rows[17].altitude_deg);
}

TEST(OusterMetadata, FillsInWhatReducedFilesLack) {
  const Metadata metadata = parse(reduced());
  EXPECT_EQ(metadata.profile, Profile::legacy);
  EXPECT_EQ(metadata.header_type, HeaderType::standard);
  EXPECT_EQ(metadata.columns_per_frame, 512U);
  EXPECT_EQ(metadata.frames_per_s, 20);
  EXPECT_EQ(metadata.columns_per_packet, 16U);
  EXPECT_EQ(metadata.window.first, 0U);
  EXPECT_EQ(metadata.window.last, 511U);
  EXPECT_EQ(metadata.serial_number, 0U);
  EXPECT_EQ(metadata.beam_origin_x_mm, 12.163);
  EXPECT_THAT(metadata.lidar_to_sensor, ElementsAre(-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1));
}

TEST(OusterMetadata, TakesTheBeamsOriginFromWhatThereIs) {
  const auto origin_mm = [](const json& change) {
    json file = reduced();
    file.update(change);
    return parse(file).beam_origin_x_mm;
  };
  EXPECT_EQ(origin_mm({{"lidar_origin_to_beam_origin_mm", 16.721}}), 16.721);
  EXPECT_EQ(origin_mm({{"prod_line", "OS-1-64"}}), 15.806);
  // First-generation units: files of firmware 1.x say "OS-1-64" and no origin, the units 12.163 later on.
  EXPECT_EQ(origin_mm({{"prod_line", "OS-1-64"}, {"prod_pn", "840-101396-03"}}), 12.163);
  EXPECT_EQ(origin_mm({{"prod_line", "OS-1-64"}, {"prod_pn", "840-101855-02"}}), 12.163);
  EXPECT_EQ(origin_mm({{"prod_line", "OS-1-64"}, {"beam_altitude_angles", angles(64, 16.729, -16.679)}}),
            12.163);
  json raised = nested();
  raised["beam_intrinsics"]["beam_to_lidar_transform"][11] = 4.5;
  EXPECT_EQ(parse(raised).beam_origin_z_mm, 4.5);
  const auto of_family = [](const char* prod_line, const char* model) {
    json file = reduced();
    file["prod_line"] = prod_line;
    return parse(file, model).beam_origin_x_mm;
  };
  EXPECT_EQ(of_family("OS-0-64-U1", "os0-64"), 27.67);
  EXPECT_EQ(of_family("OS-2-64", "os2-64"), 13.762);
}

TEST(OusterMetadata, FindsTheBeamsAmongThe64RowsOfOldFirmware) {
  // Firmware 1.13: angles of exactly zero where there is no beam.
  json file = reduced();
  for (std::size_t i = 0; i < 64; ++i) {
    if (i % 4 != 3) file["beam_altitude_angles"][i] = file["beam_azimuth_angles"][i] = 0.0;
  }
  file["data_format"] = {{"pixels_per_column", 16}};
  Metadata metadata = parse(file, "os1-16");
  EXPECT_EQ(metadata.row_count, 64U);
  EXPECT_EQ(metadata.beam_count, 16U);
  EXPECT_FALSE(metadata.rows[2].present);
  EXPECT_TRUE(metadata.rows[3].present);
  EXPECT_EQ(metadata.rows[3].ring, 15);
  EXPECT_EQ(metadata.rows[63].ring, 0);
  // Firmware 1.12: all 64 angles, whatever the model.
  json all = reduced();
  all["prod_line"] = "OS-1-32-A02";
  metadata = parse(all, "os1-32");
  EXPECT_EQ(metadata.beam_count, 32U);
  EXPECT_FALSE(metadata.rows[0].present);
  EXPECT_TRUE(metadata.rows[1].present);
  all["prod_line"] = "OS-1-16-A0";
  EXPECT_EQ(parse(all, "os1-16").beam_count, 16U);
}

TEST(OusterMetadata, ToleratesSectionsThatAreErrorMessages) {
  json file = reduced();
  for (const char* const section :
       {"sensor_info", "beam_intrinsics", "lidar_intrinsics", "lidar_data_format"}) {
    file[section] = "error: Command not recognized.";
  }
  EXPECT_EQ(parse(file).beam_count, 64U);
}

TEST(OusterMetadata, KnowsTheProfileThatAlwaysHasTheFusaHeader) {
  json file = nested();
  file["lidar_data_format"].erase("header_type");
  EXPECT_EQ(parse(file).header_type, HeaderType::standard);
  file["lidar_data_format"]["udp_profile_lidar"] = "FUSA_RNG15_RFL8_NIR8_DUAL";
  EXPECT_EQ(parse(file).header_type, HeaderType::fusa);
}

TEST(OusterMetadata, NamesTheKeyAndTheLine) {
  EXPECT_THAT(error_of("{\n\"lidar_mode\": \"1024x10\",\n\"beam_altitude_angles\": 3}"),
              HasSubstr("unit.json:3: beam_altitude_angles: is not an array"));
  EXPECT_THAT(error_of("{\"lidar_mode\": \"1024x10\"}"),
              HasSubstr("unit.json: beam_altitude_angles: is missing"));
  json file = reduced();
  file.erase("lidar_mode");
  EXPECT_THAT(error_of(file.dump()), HasSubstr(R"(lidar_mode: is missing; add "lidar_mode": "1024x10")"));
}

TEST(OusterMetadata, RefusesWhatCannotBe) {
  const auto of_reduced = [](const char* key, const json& value) {
    return error_with(reduced(), nullptr, key, value);
  };
  EXPECT_THAT(of_reduced("lidar_mode", "fast"), HasSubstr("'fast' is no mode"));
  EXPECT_THAT(of_reduced("lidar_mode", "1024x"), HasSubstr("is no mode"));
  EXPECT_THAT(of_reduced("lidar_mode", "99999x10"), HasSubstr("is no mode"));
  EXPECT_THAT(of_reduced("lidar_mode", 1024), HasSubstr("is not a string"));
  EXPECT_THAT(of_reduced("beam_azimuth_angles", angles(63, 1, 2)), HasSubstr("are 63, but 64 altitudes"));
  EXPECT_THAT(of_reduced("beam_azimuth_angles", json::array()), HasSubstr("has 0 angles"));
  EXPECT_THAT(of_reduced("beam_altitude_angles", angles(500, 1, 2)), HasSubstr("has 500 angles"));
  EXPECT_THAT(of_reduced("beam_altitude_angles", {1, "2"}), HasSubstr("element 1 is not a number"));
  EXPECT_THAT(of_reduced("beam_altitude_angles", {1, 91}), HasSubstr("element 1 is not a number between"));
  EXPECT_THAT(of_reduced("beam_altitude_angles", {1, json::array()}), HasSubstr("element 1 is not a number"));
  EXPECT_THAT(of_reduced("lidar_origin_to_beam_origin_mm", -1), HasSubstr("is not a number between"));

  const auto of_format = [](const char* key, const json& value) {
    return error_with(nested(), "lidar_data_format", key, value);
  };
  EXPECT_THAT(of_format("udp_profile_lidar", "OFF"),
              HasSubstr("'OFF' is not known; set the sensor to one of LEGACY"));
  EXPECT_THAT(of_format("header_type", "LONG"), HasSubstr("'LONG' is not known"));
  EXPECT_THAT(of_format("columns_per_frame", 0), HasSubstr("columns_per_frame: is not a number between 1"));
  EXPECT_THAT(of_format("columns_per_frame", 1e9), HasSubstr("columns_per_frame: is not a number between 1"));
  EXPECT_THAT(of_format("columns_per_packet", 7), HasSubstr("columns_per_packet: does not divide"));
  EXPECT_THAT(of_format("columns_per_packet", 1.5), HasSubstr("columns_per_packet: is not a whole number"));
  EXPECT_THAT(of_format("column_window", {0, 2048}), HasSubstr("column_window: element 1 is not a number"));
  EXPECT_THAT(of_format("column_window", {0}), HasSubstr("column_window: is not two columns"));
  EXPECT_THAT(of_format("pixels_per_column", 32), HasSubstr("pixels_per_column: is 32, but there are 64"));
  EXPECT_THAT(of_format("fps", 0), HasSubstr("fps: is not a number between 1 and"));
  const auto of_transform = [](const json& value) {
    return error_with(nested(), "lidar_intrinsics", "lidar_to_sensor_transform", value);
  };
  EXPECT_THAT(of_transform({1, 2, 3}), HasSubstr("has 3 numbers: expected 16"));
  EXPECT_THAT(of_transform({2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), HasSubstr("is no rotation"));
}

TEST(OusterMetadata, RefusesAnotherModelsFile) {
  EXPECT_THAT(error_of(nested().dump(1), "os0-64"),
              HasSubstr("prod_line: the file is that of an OS-1-64-AH, which is os1-64, not os0-64"));
  EXPECT_THAT(error_of(reduced(32).dump(), "os1-64"), HasSubstr("has 32 beams, but os1-64 has 64"));
}

TEST(OusterMetadata, RefusesWhatIsNoMetadata) {
  EXPECT_THAT(error_of(""), HasSubstr("unit.json:1: no JSON"));
  EXPECT_THAT(error_of("{\n\n\"a\": ,}"), HasSubstr("unit.json:3: no JSON"));
  EXPECT_THAT(error_of("[1, 2]"), HasSubstr("no JSON object"));
  EXPECT_THAT(error_of(R"({"a": 1e999})"), HasSubstr("unit.json:1: "));
  EXPECT_THAT(error_of(std::string(100'000, '[')), HasSubstr("nested too deep"));
  std::string nest;
  for (int i = 0; i < 50'000; ++i) nest += R"({"a":)";
  EXPECT_THAT(error_of(nest), HasSubstr("nested too deep"));
  EXPECT_THAT(error_of(std::string(2 << 20, ' ')), HasSubstr("more than 1 MiB"));
  EXPECT_THAT(error_of(std::string("{\"lidar_mode\": \"\xFF\xFE\"}")), HasSubstr("unit.json:1: "));
}

TEST(OusterMetadata, IsWhatParseCalibrationReads) {
  const std::string text = reduced().dump();
  const auto calibration =
      parse_calibration(*find_sensor_model("os1-64"), std::as_bytes(std::span(text)), "unit.json");
  EXPECT_TRUE(std::holds_alternative<Metadata>(calibration));
}

}  // namespace
}  // namespace landfix::drivers::ouster
