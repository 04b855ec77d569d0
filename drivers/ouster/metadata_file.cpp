#include "drivers/ouster/metadata_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "drivers/calibration_text.hpp"
#include "drivers/ouster/metadata_json.hpp"

namespace landfix::drivers::ouster {
namespace {

constexpr double kMaxAngleDeg = 90.0;
constexpr double kMaxLengthMm = 10'000.0;
constexpr const char* kFetchAgain =
    "; get the file from the sensor again (http://SENSOR/api/v1/sensor/metadata)";

/// "OS-1-64-U1": what it is called here, "os1-64". Nothing where it is written otherwise.
std::optional<std::string> model_name(std::string_view prod_line) {
  if (!prod_line.starts_with("OS-")) return std::nullopt;
  prod_line.remove_prefix(3);
  const std::string_view family = take_until(prod_line, '-');
  if (prod_line.empty()) return std::nullopt;
  return "os" + std::string(family) + "-" + std::string(take_until(prod_line, '-'));
}

/// "1024x10", columns a turn and turns a second.
struct LidarMode {
  std::size_t columns = 0;
  int frames_per_s = 0;
};

std::optional<LidarMode> lidar_mode(const MetadataJson& json) {
  const auto text = json.text({"config_params"}, "lidar_mode");
  if (!text) return std::nullopt;
  LidarMode mode;
  const char* const end = text->data() + text->size();
  const auto columns = std::from_chars(text->data(), end, mode.columns);
  const bool crossed = columns.ec == std::errc() && columns.ptr != end && *columns.ptr == 'x';
  const auto rate = crossed ? std::from_chars(columns.ptr + 1, end, mode.frames_per_s) : columns;
  if (!crossed || rate.ec != std::errc() || rate.ptr != end || mode.columns == 0 ||
      mode.columns > kMaxColumnsPerFrame || mode.frames_per_s < 1 || mode.frames_per_s > 40) {
    json.fail("lidar_mode", "'" + *text + "' is no mode: expected columns x rate, such as 1024x10");
  }
  return mode;
}

void read_profile(const MetadataJson& json, Metadata& metadata) {
  if (const auto name =
          json.text({"lidar_data_format", "data_format", "config_params"}, "udp_profile_lidar")) {
    const auto* const found = std::ranges::find(kProfiles, *name, &ProfileRow::name);
    if (found == kProfiles.end()) {
      std::string known;
      for (const ProfileRow& row : kProfiles) known += (known.empty() ? "" : ", ") + std::string(row.name);
      json.fail("udp_profile_lidar", "'" + *name + "' is not known; set the sensor to one of " + known);
    }
    metadata.profile = static_cast<Profile>(found - kProfiles.begin());
  }
  const auto header = json.text({"lidar_data_format", "data_format", "config_params"}, "header_type");
  if (header && *header != "STANDARD" && *header != "FUSA") {
    json.fail("header_type", "'" + *header + "' is not known; set the sensor to STANDARD or FUSA");
  }
  // Before there was a choice, one profile had the FUSA header.
  const bool fusa = metadata.profile == Profile::low_rate_dual_fusa || (header && *header == "FUSA");
  metadata.header_type =
      fusa && metadata.profile != Profile::legacy ? HeaderType::fusa : HeaderType::standard;
}

void read_columns(const MetadataJson& json, Metadata& metadata) {
  const auto mode = lidar_mode(json);
  const auto columns =
      json.count({"lidar_data_format", "data_format"}, "columns_per_frame", 1, kMaxColumnsPerFrame);
  if (!mode && !columns) json.fail("lidar_mode", R"(is missing; add "lidar_mode": "1024x10", or what it is)");
  metadata.columns_per_frame = columns ? *columns : mode->columns;
  metadata.columns_per_packet =
      json.count({"lidar_data_format", "data_format"}, "columns_per_packet", 1, kMaxColumnsPerPacket)
          .value_or(metadata.columns_per_packet);
  if (metadata.columns_per_frame % metadata.columns_per_packet != 0) {
    json.fail("columns_per_packet", std::string("does not divide the columns of a frame") + kFetchAgain);
  }
  const auto rate = json.count({"lidar_data_format", "data_format"}, "fps", 1, 40);
  metadata.frames_per_s = rate ? static_cast<int>(*rate) : mode ? mode->frames_per_s : 10;

  const auto most = static_cast<double>(metadata.columns_per_frame - 1);
  const auto window = json.numbers({"lidar_data_format", "data_format"}, "column_window", 0.0, most);
  if (window && window->size() != 2) json.fail("column_window", "is not two columns, the first and the last");
  metadata.window = window ? ColumnWindow{.first = static_cast<std::size_t>((*window)[0]),
                                          .last = static_cast<std::size_t>((*window)[1])}
                           : ColumnWindow{.first = 0, .last = metadata.columns_per_frame - 1};
}

/// Of the 64 rows that firmware up to 1.13 sends of 16 or 32 beams, those with a beam: the others have angles
/// of exactly zero (1.13), or are told by the product line, whose suffix numbers the beams of a group of four
/// from below (1.12).
bool has_beam(const Row& row, std::size_t index, std::string_view prod_line, bool all_named) {
  if (!all_named) return row.altitude_deg != 0.0 || row.azimuth_deg != 0.0;
  if (prod_line.starts_with("OS-1-16-A0")) return index % 4 == 3;
  if (prod_line.starts_with("OS-1-32-A02")) return index % 2 == 1;
  return true;
}

void rank_rings(Metadata& metadata) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < metadata.row_count; ++i) {
    if (metadata.rows[i].present) order.push_back(i);
  }
  const auto altitude_deg = [&](std::size_t beam) { return metadata.rows[order[beam]].altitude_deg; };
  for (std::size_t beam = 0; beam < order.size(); ++beam) {
    metadata.rows[order[beam]].ring = ring_of(beam, order.size(), altitude_deg);
  }
  metadata.beam_count = order.size();
}

std::vector<double> angles(const MetadataJson& json, const char* key) {
  const auto angles = json.numbers({"beam_intrinsics"}, key, -kMaxAngleDeg, kMaxAngleDeg);
  if (!angles)
    json.fail(key, std::string("is missing: without beam angles there are no points") + kFetchAgain);
  if (angles->empty() || angles->size() > kMaxRows) {
    json.fail(key, "has " + std::to_string(angles->size()) + " angles: expected one a beam, 128 at most");
  }
  return *angles;
}

void read_rows(const MetadataJson& json, std::string_view prod_line, Metadata& metadata) {
  const auto altitudes_deg = angles(json, "beam_altitude_angles");
  const auto azimuths_deg = angles(json, "beam_azimuth_angles");
  if (altitudes_deg.size() != azimuths_deg.size()) {
    json.fail("beam_azimuth_angles", "are " + std::to_string(azimuths_deg.size()) + ", but " +
                                         std::to_string(altitudes_deg.size()) + " altitudes" + kFetchAgain);
  }
  metadata.row_count = altitudes_deg.size();
  bool all_named = true;
  for (std::size_t i = 0; i < metadata.row_count; ++i) {
    metadata.rows[i] = {.altitude_deg = altitudes_deg[i], .azimuth_deg = azimuths_deg[i], .present = true};
    all_named = all_named && (altitudes_deg[i] != 0.0 || azimuths_deg[i] != 0.0);
  }
  const bool old = metadata.profile == Profile::legacy && metadata.row_count == kRowsOfOldFirmware;
  for (std::size_t i = 0; old && i < metadata.row_count; ++i) {
    metadata.rows[i].present = has_beam(metadata.rows[i], i, prod_line, all_named);
  }
  rank_rings(metadata);

  const auto pixels = json.count({"lidar_data_format", "data_format"}, "pixels_per_column", 1, kMaxRows);
  if (pixels && *pixels != metadata.row_count && !(old && *pixels == metadata.beam_count)) {
    json.fail("pixels_per_column", "is " + std::to_string(*pixels) + ", but there are " +
                                       std::to_string(metadata.row_count) + " beam angles" + kFetchAgain);
  }
}

/// From the axis to where the beams start, where the file does not tell [mm].
double default_beam_origin_mm(const MetadataJson& json, std::string_view prod_line,
                              const Metadata& metadata) {
  constexpr double kGen1 = 12.163;
  // The first generation's files of firmware 1.x lack it, and their product line is that of later ones.
  const std::string part = json.text({"sensor_info"}, "prod_pn").value_or("");
  if (part.starts_with("840-101396") || part.starts_with("840-101855")) return kGen1;
  const auto altitude_deg = [](const Row& row) { return row.altitude_deg; };
  const auto rows = std::span(metadata.rows).first(metadata.row_count);
  const double highest_deg = altitude_deg(*std::ranges::max_element(rows, {}, altitude_deg));
  const double lowest_deg = altitude_deg(*std::ranges::min_element(rows, {}, altitude_deg));
  const bool narrow = std::abs(highest_deg - 16.6) < 0.5 && std::abs(lowest_deg + 16.6) < 0.5;
  if (rows.size() == 64 && narrow) return kGen1;
  if (prod_line.starts_with("OS-0-")) return 27.67;
  if (prod_line.starts_with("OS-1-")) return 15.806;
  if (prod_line.starts_with("OS-2-")) return 13.762;
  return kGen1;
}

std::optional<std::array<double, 16>> transform(const MetadataJson& json, const char* section,
                                                const char* key) {
  const auto numbers = json.numbers({section}, key, -kMaxLengthMm, kMaxLengthMm);
  if (!numbers) return std::nullopt;
  std::array<double, 16> matrix{};
  if (numbers->size() != matrix.size()) {
    json.fail(key, "has " + std::to_string(numbers->size()) + " numbers: expected 16, four rows of four");
  }
  std::ranges::copy(*numbers, matrix.begin());
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a; b < 3; ++b) {
      const auto* const rows = matrix.data();
      const double product = std::inner_product(rows + 4 * a, rows + 4 * a + 3, rows + 4 * b, 0.0);
      if (std::abs(product - (a == b ? 1.0 : 0.0)) > 1e-3)
        json.fail(key, std::string("is no rotation") + kFetchAgain);
    }
  }
  return matrix;
}

void read_transforms(const MetadataJson& json, std::string_view prod_line, Metadata& metadata) {
  if (const auto beam_to_lidar = transform(json, "beam_intrinsics", "beam_to_lidar_transform")) {
    metadata.beam_origin_x_mm = (*beam_to_lidar)[3];
    metadata.beam_origin_z_mm = (*beam_to_lidar)[11];
  } else {
    metadata.beam_origin_x_mm =
        json.number({"beam_intrinsics"}, "lidar_origin_to_beam_origin_mm", 0.0, 1000.0)
            .value_or(default_beam_origin_mm(json, prod_line, metadata));
  }
  if (const auto lidar_to_sensor = transform(json, "lidar_intrinsics", "lidar_to_sensor_transform")) {
    metadata.lidar_to_sensor = *lidar_to_sensor;
  }
}

/// A decimal number in a string; 0 where it is not one.
std::uint64_t serial_number(const MetadataJson& json) {
  const nlohmann::json* const value = json.find({"sensor_info"}, "prod_sn");
  if (value == nullptr) return 0;
  if (value->is_number_unsigned()) return value->get<std::uint64_t>();
  if (!value->is_string()) return 0;
  const auto& text = value->get_ref<const std::string&>();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

void check_model(const MetadataJson& json, const SensorModel& model, std::string_view prod_line,
                 const Metadata& metadata) {
  const auto name = model_name(prod_line);
  if (name && *name != model.name) {
    json.fail("prod_line", "the file is that of an " + std::string(prod_line) + ", which is " + *name +
                               ", not " + std::string(model.name));
  }
  if (metadata.beam_count != model.beam_count) {
    json.fail("beam_altitude_angles",
              "has " + std::to_string(metadata.beam_count) + " beams, but " + std::string(model.name) +
                  " has " + std::to_string(model.beam_count) + ": is the file another sensor's?");
  }
}

}  // namespace

Metadata parse_metadata(const SensorModel& model, std::span<const std::byte> file, std::string_view name) {
  const MetadataJson json(file, name);
  const std::string prod_line = json.text({"sensor_info"}, "prod_line").value_or("");
  Metadata metadata;
  read_profile(json, metadata);
  read_columns(json, metadata);
  read_rows(json, prod_line, metadata);
  read_transforms(json, prod_line, metadata);
  metadata.serial_number = serial_number(json);
  check_model(json, model, prod_line, metadata);
  return metadata;
}

}  // namespace landfix::drivers::ouster
