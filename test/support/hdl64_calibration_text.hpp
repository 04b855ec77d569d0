// Calibration files of the HDL-64E, whole and sound, for tests and fuzzers.
#pragma once

#include <string>
#include <vector>

namespace landfix::test {

/// A line an element, so that the lines of errors are known: the header has 3, laser i begins at 4 + 11 i.
inline std::string xml_points(int count = 64) {
  std::string text = "<boost_serialization>\n<DB><distLSB_>0.2</distLSB_>\n<points_><count>64</count>\n";
  for (int i = 0; i < count; ++i) {
    const std::string id = std::to_string(i);
    text += "<item><px>\n<id_>" + id + "</id_>\n<rotCorrection_>-1.5</rotCorrection_>\n<vertCorrection_>-" +
            id +
            ".25</vertCorrection_>\n<distCorrection_>125</distCorrection_>\n"
            "<distCorrectionX_>131.5</distCorrectionX_>\n<distCorrectionY_>128</distCorrectionY_>\n"
            "<vertOffsetCorrection_>20.5</vertOffsetCorrection_>\n"
            "<horizOffsetCorrection_>-2.6</horizOffsetCorrection_>\n"
            "<focalDistance_>1050</focalDistance_><focalSlope_>1.85</focalSlope_>\n</px></item>\n";
  }
  return text + "</points_>\n";
}
inline const std::string kHdl64XmlEnd = "</DB></boost_serialization>\n";

inline std::string xml_array(const std::string& name, const std::vector<int>& values) {
  std::string text = "<" + name + "><count>64</count>\n";
  for (const int value : values) text += "<item>" + std::to_string(value) + "</item>\n";
  return text + "</" + name + ">\n";
}

/// A line a key: the header has one, laser i begins at 2 + 12 i.
inline std::string yaml_lasers(int count = 64) {
  std::string text = "lasers:\n";
  for (int i = 0; i < count; ++i) {
    const std::string id = std::to_string(i);
    text +=
        "- dist_correction: 1.25\n  dist_correction_x: 1.315\n  dist_correction_y: 1.28\n"
        "  focal_distance: 10.5\n  focal_slope: 1.85\n  horiz_offset_correction: -0.026\n  laser_id: " +
        id +
        "\n  min_intensity: 20\n  rot_correction: -0.025\n  two_pt_correction_available: true\n"
        "  vert_correction: -0.0" +
        (i < 10 ? "0" : "") + id + "\n  vert_offset_correction: 0.205\n";
  }
  return text;
}

}  // namespace landfix::test
