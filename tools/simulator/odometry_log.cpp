#include "tools/simulator/odometry_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <fmt/format.h>

#include "platform/candump_log.hpp"
#include "tools/simulator/gnss_receiver.hpp"
#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::uint32_t kSpeedId = 0x1A0;
constexpr std::uint32_t kYawRateId = 0x1A1;
constexpr std::int64_t kPeriod_ns = 10'000'000;  // of the speed; the yaw rate comes every other time
constexpr std::int64_t kGnssEvery = 20;          // times
constexpr std::int64_t kLatency_ns = 2'000'000;  // from the wheels to the bus
constexpr std::int64_t kStandBefore_ns = 500'000'000;

constexpr double kSpeedStep_mps = 0.01 / 3.6;
constexpr double kSpeedScaleError = 1.005;  // worn tyres
constexpr double kSpeedNoise_mps = 0.02;
constexpr double kYawRateStep_radps = 0.01 * std::numbers::pi / 180.0;
constexpr double kYawRateBias_radps = 0.05 * std::numbers::pi / 180.0;
constexpr double kYawRateNoise_radps = 0.1 * std::numbers::pi / 180.0;

[[nodiscard]] double yaw_rate_at(const VehicleMotion& vehicle, double time_s) {
  constexpr double kHalf_s = 0.005;
  const auto yaw_rad = [&vehicle](double at_s) {
    return ndt::to_roll_pitch_yaw(vehicle.pose_at(at_s).linear()).yaw_rad;
  };
  const double turned_rad =
      std::remainder(yaw_rad(time_s + kHalf_s) - yaw_rad(time_s - kHalf_s), 2.0 * std::numbers::pi);
  return turned_rad / (2.0 * kHalf_s);
}

[[nodiscard]] platform::CanFrame frame_of(std::uint32_t id, std::uint8_t first, std::uint8_t second) {
  platform::CanFrame frame{.id = id, .length = 8, .data = {}};
  frame.data[0] = std::byte{first};
  frame.data[1] = std::byte{second};
  return frame;
}

/// Bits 0 to 15, little-endian, unsigned: a speed is never negative.
[[nodiscard]] platform::CanFrame speed_frame(double speed_mps) {
  const double steps = std::clamp(std::round(speed_mps / kSpeedStep_mps), 0.0, 65534.0);
  const auto raw = static_cast<std::uint16_t>(steps);
  return frame_of(kSpeedId, static_cast<std::uint8_t>(raw & 0xFF), static_cast<std::uint8_t>(raw >> 8));
}

/// Bits 7 to 8, big-endian, signed.
[[nodiscard]] platform::CanFrame yaw_rate_frame(double rate_radps) {
  const double steps = std::clamp(std::round(rate_radps / kYawRateStep_radps), -32767.0, 32767.0);
  const auto raw = static_cast<std::uint16_t>(static_cast<std::int16_t>(steps));
  return frame_of(kYawRateId, static_cast<std::uint8_t>(raw >> 8), static_cast<std::uint8_t>(raw & 0xFF));
}

}  // namespace

void write_odometry_log(const Drive& drive, const std::filesystem::path& path) {
  const VehicleMotion& vehicle = drive.vehicle();
  platform::CandumpLog log(path, "can0");
  Random noise(drive.seed(), RandomStream::odometry);
  GnssReceiver gnss(drive);
  const auto end_ns = static_cast<std::int64_t>(vehicle.duration_s() * 1e9);
  std::int64_t count = 0;
  for (std::int64_t at_ns = -kStandBefore_ns; at_ns < end_ns; at_ns += kPeriod_ns, ++count) {
    const double time_s = static_cast<double>(at_ns) * 1e-9;
    const std::int64_t stamp_utc_ns = kDriveStart_utc_ns + at_ns + kLatency_ns;
    const double speed_mps = vehicle.speed_at(time_s);
    // A wheel that stands says so.
    const double error_mps = speed_mps > 0.1 ? kSpeedNoise_mps * noise.normal() : 0.0;
    // What the disk refuses, commit() says.
    const platform::CanFrame speed = speed_frame(kSpeedScaleError * speed_mps + error_mps);
    (void)log.send({&speed, 1}, stamp_utc_ns);
    if (count % 2 != 0) continue;
    const double rate_radps =
        yaw_rate_at(vehicle, time_s) + kYawRateBias_radps + kYawRateNoise_radps * noise.normal();
    const platform::CanFrame yaw_rate = yaw_rate_frame(rate_radps);
    (void)log.send({&yaw_rate, 1}, stamp_utc_ns);
    if (count % kGnssEvery == 0) (void)log.send(gnss.frames_at(time_s), stamp_utc_ns);
  }
  log.commit();
}

std::string odometry_section() {
  return fmt::format(
      "# For `landfix replay --odometry odometry.log`.\n"
      "[[odometry.signal]]\nrole = \"speed\"\nid = 0x{:X}\nstart = 0\nlength = 16\nscale = 0.01\n"
      "unit = \"km/h\"\ninvalid_raw = [0xFFFF]\n\n"
      "[[odometry.signal]]\nrole = \"yaw_rate\"\nid = 0x{:X}\nstart = 7\nlength = 16\norder = \"motorola\"\n"
      "signed = true\nscale = 0.01\nunit = \"deg/s\"\ninvalid_raw = [0x8000]\n",
      kSpeedId, kYawRateId);
}

}  // namespace landfix::tools::simulator
