#include "tools/simulator/gnss_receiver.hpp"

#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "ndt/pose.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::uint32_t kPositionId = 0x1B0;
constexpr std::uint32_t kHeadingId = 0x1B1;
constexpr double kStep_deg = 1e-7;
constexpr double kHeadingStep_deg = 0.01;
constexpr double kAltitudeStep_m = 0.01;

const Eigen::Vector3d kAntenna_m(0.5, 0.0, 1.5);
const Eigen::Vector3d kError_m(1.2, -0.8, 1.5);
constexpr double kNoise_m = 0.3;
constexpr double kHeadingError_deg = 0.7;
constexpr double kHeadingNoise_deg = 0.3;

constexpr double kLatitude_deg = 49.0;
constexpr double kLongitude_deg = 8.4;
constexpr double kAltitude_m = 110.0;

void put(platform::CanFrame& frame, std::size_t at, std::size_t bytes, double steps) {
  const auto raw = static_cast<std::uint32_t>(std::llround(steps));
  for (std::size_t i = 0; i < bytes; ++i) frame.data[at + i] = static_cast<std::byte>(raw >> 8 * i & 0xFF);
}

}  // namespace

GnssReceiver::GnssReceiver(const Drive& drive)
    : drive_(drive),
      projection_(platform::LocalCartesianMap{
          .plane = GeographicLib::LocalCartesian(kLatitude_deg, kLongitude_deg, kAltitude_m)}),
      noise_(drive.seed(), RandomStream::gnss) {}

std::array<platform::CanFrame, 2> GnssReceiver::frames_at(double time_s) {
  const ndt::Pose pose = drive_.vehicle().pose_at(time_s);
  const Eigen::Vector3d noise_m(noise_.normal(), noise_.normal(), noise_.normal());
  const Eigen::Vector3d antenna_m = pose * kAntenna_m + kError_m + kNoise_m * noise_m;
  const platform::GeodeticPosition position = platform::to_geodetic(projection_, antenna_m);
  const double north_rad = platform::to_map(projection_, position).north_rad;
  const double yaw_rad = ndt::to_roll_pitch_yaw(pose.linear()).yaw_rad;
  const double heading_deg =
      (north_rad - yaw_rad) / ndt::kRadians_per_deg + kHeadingError_deg + kHeadingNoise_deg * noise_.normal();

  std::array<platform::CanFrame, 2> frames{
      {{.id = kPositionId, .length = 8, .data = {}}, {.id = kHeadingId, .length = 8, .data = {}}}};
  put(frames[0], 0, 4, position.latitude_deg / kStep_deg);
  put(frames[0], 4, 4, position.longitude_deg / kStep_deg);
  put(frames[1], 0, 2, (heading_deg - 360.0 * std::floor(heading_deg / 360.0)) / kHeadingStep_deg);
  put(frames[1], 2, 4, position.altitude_m / kAltitudeStep_m);
  return frames;
}

std::string gnss_section() {
  const auto signal = [](std::string_view role, std::uint32_t id, int start, int length, bool is_signed,
                         double scale) {
    return fmt::format(
        "\n[[gnss.signal]]\nrole = \"{}\"\nid = 0x{:X}\nstart = {}\nlength = {}\nsigned = {}\nscale = {}\n",
        role, id, start, length, is_signed, scale);
  };
  return fmt::format(
             "# In the same log: where to look for the vehicle where [initial_pose] has no pose.\n"
             "[gnss]\nantenna = [{:.1f}, {:.1f}, {:.1f}]\n",
             kAntenna_m.x(), kAntenna_m.y(), kAntenna_m.z()) +
         signal("latitude", kPositionId, 0, 32, true, kStep_deg) +
         signal("longitude", kPositionId, 32, 32, true, kStep_deg) +
         signal("heading", kHeadingId, 0, 16, false, kHeadingStep_deg) +
         signal("altitude", kHeadingId, 16, 32, true, kAltitudeStep_m);
}

std::string projector_info() {
  return fmt::format(
      "projector_type: LocalCartesian\nvertical_datum: WGS84\n"
      "map_origin:\n  latitude: {}\n  longitude: {}\n  altitude: {}\n",
      kLatitude_deg, kLongitude_deg, kAltitude_m);
}

}  // namespace landfix::tools::simulator
