#include "tools/simulator/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/nanoseconds.hpp"
#include "platform/pcap_writer.hpp"
#include "platform/pcd_writer.hpp"
#include "platform/trajectory.hpp"
#include "tools/simulator/gnss_receiver.hpp"
#include "tools/simulator/odometry_log.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/survey.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::uint32_t kSensorAddress = 0xC0A801C9;  // 192.168.1.201, the maker's default
constexpr double kLeaf_m = 2.0;
constexpr double kResolution_m = 1.0;

platform::UdpFlow flow_from_sensor(std::uint16_t port) {
  return {.source_address = kSensorAddress, .source_port = port, .destination_port = port};
}

/// From a packet's end to the receiver's stamp: the sensor's own delay, and a network that is never quite
/// even.
std::int64_t latency_ns(std::uint64_t seed, std::uint64_t packet) {
  const double jitter = to_unit(random_bits(seed, RandomStream::network, packet));
  return 280'000 + static_cast<std::int64_t>(40'000.0 * jitter);
}

/// Around an invented survey point; the map's x axis points east.
GpsFix gps_fix(const VehicleMotion& vehicle, std::int64_t utc_ns) {
  constexpr double kLatitude_deg = 48.1173;
  constexpr double kLongitude_deg = 11.5167;
  constexpr double kDegree_m = 111'320.0;
  const double time_s = 1e-9 * static_cast<double>(utc_ns - kDriveStart_utc_ns);
  const ndt::Pose pose = vehicle.pose_at(time_s);
  const double yaw_deg = ndt::to_roll_pitch_yaw(pose.linear()).yaw_rad * 180.0 / std::numbers::pi;
  const double shrink = std::cos(kLatitude_deg * std::numbers::pi / 180.0);
  return {.utc_ns = utc_ns,
          .latitude_deg = kLatitude_deg + pose.translation().y() / kDegree_m,
          .longitude_deg = kLongitude_deg + pose.translation().x() / (kDegree_m * shrink),
          .speed_mps = vehicle.speed_at(time_s),
          .course_deg = std::fmod(450.0 - yaw_deg, 360.0)};
}

/// Packets `first` to `first + payloads.size()`, shared out between the processors.
std::size_t fire_batch(const Drive& drive, std::size_t first, std::span<std::vector<std::byte>> payloads) {
  const std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::size_t> returns(workers, 0);
  const auto work = [&](std::size_t worker) {
    for (std::size_t i = worker; i < payloads.size(); i += workers) {
      const std::vector<Echo> echoes = drive.fire(first + i);
      payloads[i] = drive.lidar().encode(first + i, drive.packet_utc_ns(first + i), echoes);
      returns[worker] += static_cast<std::size_t>(
          std::ranges::count_if(echoes, [](const Echo& echo) { return echo.range_m > 0.0; }));
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
    work(0);
  }
  std::size_t sum = 0;
  for (const std::size_t count : returns) sum += count;
  return sum;
}

void write_capture(const Drive& drive, const std::filesystem::path& path, const Progress& progress,
                   SimulationSummary& summary) {
  constexpr std::size_t kBatch = 512;
  const LidarTraits& lidar = drive.lidar().traits();
  const platform::UdpFlow data = flow_from_sensor(lidar.data_port);
  const platform::UdpFlow telemetry = flow_from_sensor(lidar.telemetry_port);
  platform::PcapWriter capture(path);
  std::int64_t telemetry_utc_ns = kDriveStart_utc_ns;
  std::vector<std::vector<std::byte>> payloads(kBatch);
  for (std::size_t first = 0; first < drive.packets(); first += kBatch) {
    const std::size_t count = std::min(kBatch, drive.packets() - first);
    summary.returns += fire_batch(drive, first, std::span(payloads).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t finished_utc_ns = drive.packet_utc_ns(first + i) + lidar.packet_ns;
      const std::int64_t receive_utc_ns = finished_utc_ns + latency_ns(drive.seed(), first + i);
      if (lidar.telemetry_port != 0 && telemetry_utc_ns < receive_utc_ns) {
        const GpsFix fix = gps_fix(drive.vehicle(), telemetry_utc_ns);
        capture.write(telemetry, drive.lidar().encode_telemetry(fix), telemetry_utc_ns);
        telemetry_utc_ns += platform::kNs_per_s;
        ++summary.telemetry_packets;
      }
      capture.write(data, payloads[i], receive_utc_ns);
    }
    summary.data_packets += count;
    progress(static_cast<double>(first + count) / static_cast<double>(drive.packets()));
  }
  capture.commit();
}

void write_truth(const Drive& drive, const std::filesystem::path& path) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  constexpr std::int64_t kMargin_ns = 100'000'000;
  const auto duration_ns = static_cast<std::int64_t>(drive.vehicle().duration_s() * 1e9);
  std::vector<platform::StampedPose> truth;
  std::int64_t stamp_utc_ns = (kDriveStart_utc_ns - kMargin_ns) / kPeriod_ns * kPeriod_ns;
  for (; stamp_utc_ns < kDriveStart_utc_ns + duration_ns + kMargin_ns; stamp_utc_ns += kPeriod_ns) {
    const double time_s = 1e-9 * static_cast<double>(stamp_utc_ns - kDriveStart_utc_ns);
    truth.push_back({stamp_utc_ns, drive.vehicle().pose_at(time_s)});
  }
  platform::write_tum(path, truth);
}

/// Point by point: a city's would fill the memory.
std::size_t write_map(const Drive& drive, const std::filesystem::path& path) {
  std::size_t points = 0;
  platform::PcdStream cloud(path, platform::kPositionMembers);
  survey(drive.world().surveyed, drive.ground(), drive.route().survey, drive.seed(),
         [&](const Eigen::Vector3f& point_m) {
           cloud.write(std::as_bytes(std::span(&point_m, 1)));
           ++points;
         });
  cloud.commit();
  return points;
}

void write_config(const Drive& drive, const std::filesystem::path& path) {
  const SensorMounting& mounting = kSensorMounting;
  const ndt::Pose start = drive.vehicle().pose_at(0.0);
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(start.linear());
  const LidarTraits& lidar = drive.lidar().traits();
  const std::optional<CalibrationFile> calibration = drive.lidar().calibration();
  platform::AtomicFile file(path);
  file.write(fmt::format(
      "# The simulated drive of route {}, seed {}, unit {} of its sensor. Build map.ndt from map.pcd with "
      "`landfix map`.\n"
      "[sensor]\nmodel = \"{}\"\nport = {}\n{}\n"
      "[vehicle]\nsensor_pose = [{:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}]\n\n"
      "[map]\nfile = \"map.ndt\"\nprojector = \"map_projector_info.yaml\"\n\n"
      "# Where the vehicle stands when the capture begins.\n"
      "[initial_pose]\npose = [{:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}]\n\n"
      "[filter]\nleaf_m = {:.1f}\n\n[matcher]\nresolution_m = {:.1f}\nmax_iterations = 50\n\n{}\n{}",
      drive.route().name, drive.seed(), drive.unit(), lidar.name, lidar.data_port,
      calibration ? fmt::format("calibration = \"{}\"\n", calibration->name) : "", mounting.position_m.x(),
      mounting.position_m.y(), mounting.position_m.z(), mounting.roll_deg, mounting.pitch_deg,
      mounting.yaw_deg, start.translation().x(), start.translation().y(), start.translation().z(),
      angles.roll_rad / ndt::kRadians_per_deg, angles.pitch_rad / ndt::kRadians_per_deg,
      angles.yaw_rad / ndt::kRadians_per_deg, kLeaf_m, kResolution_m, odometry_section(), gnss_section()));
  file.commit();
}

}  // namespace

SimulationSummary write_drive(const Drive& drive, const std::filesystem::path& folder,
                              const Progress& progress) {
  std::filesystem::create_directories(folder);
  SimulationSummary summary{.length_m = drive.route().length_m(), .duration_s = drive.vehicle().duration_s()};
  write_capture(drive, folder / "capture.pcap", progress, summary);
  write_truth(drive, folder / "truth.tum");
  write_odometry_log(drive, folder / "odometry.log");
  summary.map_points = write_map(drive, folder / "map.pcd");
  write_config(drive, folder / "config.toml");
  platform::write_file(folder / "map_projector_info.yaml", projector_info());
  if (const auto calibration = drive.lidar().calibration())
    platform::write_file(folder / calibration->name, calibration->text);
  return summary;
}

}  // namespace landfix::tools::simulator
