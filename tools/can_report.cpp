#include "tools/can_report.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ndt/localizer.hpp"
#include "ndt/pose.hpp"

namespace landfix::tools {
namespace {

using platform::E2eStatus;
using platform::PoseReport;

constexpr double kDeg_per_rad = 1.0 / ndt::kRadians_per_deg;

struct Number {
  std::string_view key;
  double PoseReport::*value;
  double factor = 1.0;
};

// The keys are what other programs rely on.
constexpr std::array kNumbers{
    Number{"x_m", &PoseReport::x_m},
    Number{"y_m", &PoseReport::y_m},
    Number{"z_m", &PoseReport::z_m},
    Number{"roll_deg", &PoseReport::roll_rad, kDeg_per_rad},
    Number{"pitch_deg", &PoseReport::pitch_rad, kDeg_per_rad},
    Number{"yaw_deg", &PoseReport::yaw_rad, kDeg_per_rad},
    Number{"speed_x_mps", &PoseReport::speed_x_mps},
    Number{"speed_y_mps", &PoseReport::speed_y_mps},
    Number{"speed_z_mps", &PoseReport::speed_z_mps},
    Number{"roll_rate_degps", &PoseReport::roll_rate_radps, kDeg_per_rad},
    Number{"pitch_rate_degps", &PoseReport::pitch_rate_radps, kDeg_per_rad},
    Number{"yaw_rate_degps", &PoseReport::yaw_rate_radps, kDeg_per_rad},
    Number{"sigma_along_m", &PoseReport::sigma_along_m},
    Number{"sigma_cross_m", &PoseReport::sigma_cross_m},
    Number{"sigma_up_m", &PoseReport::sigma_up_m},
    Number{"sigma_roll_deg", &PoseReport::sigma_roll_rad, kDeg_per_rad},
    Number{"sigma_pitch_deg", &PoseReport::sigma_pitch_rad, kDeg_per_rad},
    Number{"sigma_yaw_deg", &PoseReport::sigma_yaw_rad, kDeg_per_rad},
    Number{"score", &PoseReport::score},
    Number{"iterations", &PoseReport::iterations},
    Number{"age_s", &PoseReport::age_s},
};

/// Seconds, with the decimals that are known.
std::string seconds(std::int64_t stamp_utc_ns) {
  if (stamp_utc_ns < 0) return "-";
  return fmt::format("{}.{:09}", stamp_utc_ns / 1'000'000'000, stamp_utc_ns % 1'000'000'000);
}

std::string number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string_view state_name(const PoseReport& pose) {
  return ndt::to_string(static_cast<ndt::State>(pose.state));
}

}  // namespace

std::string_view to_string(CanFaultKind kind) {
  constexpr std::array<std::string_view, kCanFaultKinds> kNames{
      "wrong_crc", "repeated", "lost", "wrong_sequence", "out_of_order", "incomplete_pose", "silence"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<CanFault> faults_of(const platform::DecodedFrame& decoded, std::int64_t stamp_utc_ns) {
  std::vector<CanFault> faults;
  if (!decoded.has_fault()) return faults;
  const auto add = [&](CanFaultKind kind, std::string what) {
    faults.push_back({stamp_utc_ns, decoded.layout->name, kind, std::move(what)});
  };
  const unsigned step = decoded.check.step;
  switch (decoded.check.status) {
    case E2eStatus::ok:
      break;
    case E2eStatus::ok_some_lost:
      add(CanFaultKind::lost, fmt::format("{} missing before it", step - 1));
      break;
    case E2eStatus::repeated:
      add(CanFaultKind::repeated, "its counter stands still; left out");
      break;
    case E2eStatus::wrong_sequence:
      add(CanFaultKind::wrong_sequence,
          fmt::format("its counter jumps by {}: {} missing before it, or it comes late; left out", step,
                      step - 1));
      break;
    case E2eStatus::wrong_crc:
      add(CanFaultKind::wrong_crc, "damaged, or not the frame that its identifier says; left out");
      break;
  }
  if (decoded.silence_ns != 0) {
    add(CanFaultKind::silence,
        fmt::format("no pose frame for {:.3f} s", static_cast<double>(decoded.silence_ns) * 1e-9));
  }
  if (decoded.frames_missing != 0) {
    add(CanFaultKind::incomplete_pose,
        fmt::format("the pose before it lacks {} of its frames; left out", decoded.frames_missing));
  }
  if (decoded.out_of_order) add(CanFaultKind::out_of_order, "a later frame of its pose came before it");
  return faults;
}

CanFault end_of_log_fault(std::size_t frames_missing, std::int64_t stamp_utc_ns) {
  return {stamp_utc_ns, "end", CanFaultKind::incomplete_pose,
          fmt::format("the last pose lacks {} of its frames; left out", frames_missing)};
}

nlohmann::ordered_json to_json(const PoseReport& pose) {
  nlohmann::ordered_json json;
  json["stamp_utc_ns"] = nullptr;
  if (pose.stamp_utc_ns >= 0) json["stamp_utc_ns"] = pose.stamp_utc_ns;
  for (const Number& number : kNumbers) json[std::string(number.key)] = pose.*number.value * number.factor;
  json["state"] = state_name(pose);
  json["time_source"] = pose.time_source;
  json["saturated"] = pose.saturated != 0;
  json["partial_sweep"] = pose.partial_sweep != 0;
  json["weak"] = pose.weak != 0;
  json["weak_axes"] = pose.weak_axes;
  json["map_hash"] = pose.map_hash;
  json["map_origin"] = pose.map_origin;
  return json;
}

nlohmann::ordered_json to_json_geodetic(const PoseReport& place) {
  return {{"latitude_deg", place.latitude_deg},
          {"longitude_deg", place.longitude_deg},
          {"utm_zone", place.utm_zone},
          {"state", state_name(place)}};
}

nlohmann::ordered_json to_json(const CanFault& fault) {
  return {{"stamp_utc_ns", fault.stamp_utc_ns},
          {"frame", fault.frame},
          {"kind", to_string(fault.kind)},
          {"what", fault.what}};
}

std::string pose_title() {
  return fmt::format("{:>21} {:>10} {:>10} {:>8} {:>8} {:>8} {:>9} {:>7} {:>13} {:>10}  {}\n",
                     "# holds at [s]", "x [m]", "y [m]", "z [m]", "roll", "pitch", "yaw [deg]", "[m/s]",
                     "sigma along", "across [m]", "state");
}

std::string to_line(const PoseReport& pose) {
  const auto deg = [](double angle_rad) { return number(angle_rad * kDeg_per_rad, 3); };
  return fmt::format("{:>21} {:>10} {:>10} {:>8} {:>8} {:>8} {:>9} {:>7} {:>13} {:>10}  {}\n",
                     seconds(pose.stamp_utc_ns), number(pose.x_m, 3), number(pose.y_m, 3),
                     number(pose.z_m, 3), deg(pose.roll_rad), deg(pose.pitch_rad), deg(pose.yaw_rad),
                     number(pose.speed_x_mps, 2), number(pose.sigma_along_m, 3),
                     number(pose.sigma_cross_m, 3), state_name(pose));
}

std::string to_line_geodetic(const PoseReport& place) {
  return fmt::format("@ latitude {} deg, longitude {} deg  {}\n", number(place.latitude_deg, 9),
                     number(place.longitude_deg, 9), state_name(place));
}

std::string to_line(const CanFault& fault) {
  return fmt::format("! received at {}: {}: {}: {}\n", seconds(fault.stamp_utc_ns), fault.frame,
                     to_string(fault.kind), fault.what);
}

}  // namespace landfix::tools
