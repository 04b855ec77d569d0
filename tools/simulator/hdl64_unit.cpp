#include "tools/simulator/hdl64_unit.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kRadians_per_centideg = std::numbers::pi / 18'000.0;

std::string xml_array(std::string_view name, int value) {
  std::string text = fmt::format("\t<{}>\n\t\t<count>64</count>\n\t\t<item_version>0</item_version>\n", name);
  for (int i = 0; i < 64; ++i) text += fmt::format("\t\t<item>{}</item>\n", value);
  return text + fmt::format("\t</{}>\n", name);
}

/// CRC-16 by polynomial division, from 0, most significant bit first.
std::uint16_t crc16(std::uint16_t crc, std::uint8_t byte) {
  for (unsigned mask = 0x80; mask != 0; mask >>= 1) {
    const bool carry = ((crc >> 15 & 1U) != 0) != ((byte & mask) != 0);
    crc = static_cast<std::uint16_t>(crc << 1);
    if (carry) crc ^= 0x8005;
  }
  return crc;
}

}  // namespace

std::array<Hdl64UnitLaser, 64> hdl64_unit() {
  std::array<Hdl64UnitLaser, 64> lasers{};
  for (int i = 0; i < 64; ++i) {
    const bool upper = i < 32;
    // Neighbours in the order of firing are not neighbours in space.
    const int place = i * 11 % 32;
    Hdl64UnitLaser& laser = lasers[static_cast<std::size_t>(i)];
    laser.elevation_centideg = upper ? -840 + 34 * place : -2460 + 49 * place;
    laser.rotation_centideg = (upper ? -600 : -650) + 41 * (i * 7 % 32);
    laser.range_mm = 1250 + 3 * (i * 13 % 64);
    const double slope = std::tan(laser.elevation_centideg * kRadians_per_centideg);
    laser.height_mm = static_cast<int>(std::lround((upper ? 205.0 : 140.0) + 68.0 * slope));
    laser.left_mm = i % 2 == 0 ? 26 : -26;
    laser.focal_distance_mm = 9000 + 500 * (i % 8);
  }
  return lasers;
}

std::string hdl64_db_xml() {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"4\">\n<DB>\n"
      "\t<distLSB_>0.2</distLSB_>\n";
  text += xml_array("enabled_", 1) + xml_array("minIntensity_", 0) + xml_array("maxIntensity_", 255);
  text += "\t<points_>\n\t\t<count>64</count>\n";
  int id = 0;
  for (const Hdl64UnitLaser& laser : hdl64_unit()) {
    const double range_cm = 0.1 * laser.range_mm;
    text += fmt::format(
        "\t\t<item>\n\t\t\t<px>\n\t\t\t\t<id_>{}</id_>\n\t\t\t\t<rotCorrection_>{:.2f}</rotCorrection_>\n"
        "\t\t\t\t<vertCorrection_>{:.2f}</vertCorrection_>\n\t\t\t\t<distCorrection_>{:.1f}</"
        "distCorrection_>\n"
        "\t\t\t\t<distCorrectionX_>{:.1f}</distCorrectionX_>\n"
        "\t\t\t\t<distCorrectionY_>{:.1f}</distCorrectionY_>\n"
        "\t\t\t\t<vertOffsetCorrection_>{:.1f}</vertOffsetCorrection_>\n"
        "\t\t\t\t<horizOffsetCorrection_>{:.1f}</horizOffsetCorrection_>\n"
        "\t\t\t\t<focalDistance_>{:.1f}</focalDistance_>\n\t\t\t\t<focalSlope_>0</focalSlope_>\n"
        "\t\t\t</px>\n\t\t</item>\n",
        id++, 0.01 * laser.rotation_centideg, 0.01 * laser.elevation_centideg, range_cm, range_cm, range_cm,
        0.1 * laser.height_mm, 0.1 * laser.left_mm, 0.1 * laser.focal_distance_mm);
  }
  return text + "\t</points_>\n</DB>\n</boost_serialization>\n";
}

std::string hdl64_yaml() {
  std::string text = "distance_resolution: 0.002\nnum_lasers: 64\nlasers:\n";
  int id = 0;
  for (const Hdl64UnitLaser& laser : hdl64_unit()) {
    text += fmt::format(
        "- {{laser_id: {}, rot_correction: {}, vert_correction: {}, dist_correction: {:.3f},\n"
        "    two_pt_correction_available: true, dist_correction_x: {:.3f}, dist_correction_y: {:.3f},\n"
        "    vert_offset_correction: {:.3f}, horiz_offset_correction: {:.3f}, focal_distance: {:.3f},\n"
        "    focal_slope: 0, min_intensity: 0, max_intensity: 255}}\n",
        id++, kRadians_per_centideg * laser.rotation_centideg,
        kRadians_per_centideg * laser.elevation_centideg, 1e-3 * laser.range_mm, 1e-3 * laser.range_mm,
        1e-3 * laser.range_mm, 1e-3 * laser.height_mm, 1e-3 * laser.left_mm, 1e-3 * laser.focal_distance_mm);
  }
  return text;
}

std::vector<std::uint8_t> hdl64_set(Hdl64SetKind kind) {
  std::vector<std::uint8_t> set;
  set.reserve(1820);
  const auto put16 = [&set](int value) {
    set.push_back(static_cast<std::uint8_t>(value & 0xFF));
    set.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
  };
  for (const char c : std::string_view("UNIT#")) set.push_back(static_cast<std::uint8_t>(c));
  set.insert(set.end(), {45, 50});  // thresholds of the blocks
  std::uint16_t crc = 0;
  std::uint8_t id = 0;
  for (const Hdl64UnitLaser& laser : hdl64_unit()) {
    set.push_back(id++);
    const std::size_t checked = set.size();
    put16(laser.elevation_centideg);
    put16(laser.rotation_centideg);
    for (int i = 0; i < 3; ++i) put16(laser.range_mm);
    put16(laser.height_mm);
    put16(laser.left_mm);
    put16(laser.focal_distance_mm);
    put16(0);  // focal slope
    set.insert(set.end(), {0, 255});
    for (const std::uint8_t byte : std::span(set).subspan(checked)) crc = crc16(crc, byte);
    if (id < 64) set.insert(set.end(), 7, 0);  // warnings, reserved
  }
  set.insert(set.end(), {15, 6, 12, 10, 30, 0, 40});  // calibrated 2015-06-12 10:30:00, humidity
  put16(600);                                         // rpm
  put16(0);
  put16(36000);                                                // field of view
  put16(321);                                                  // hours of life
  set.insert(set.end(), {192, 168, 3, 43, 192, 168, 3, 255});  // from, to
  set.insert(set.end(), {0, 0, 0xA4});                         // strongest return, warnings, power
  put16(kind == Hdl64SetKind::s3 ? crc : 1820);
  return set;
}

}  // namespace landfix::tools::simulator
