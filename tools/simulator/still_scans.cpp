#include "tools/simulator/still_scans.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "platform/pcd_writer.hpp"
#include "platform/trajectory.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::int64_t kTurn_ns = 100'000'000;  // rotor_angle_deg

/// Appends what the packet's echoes say is there, frame `vehicle`.
void add_points(const Drive& drive, std::size_t packet, const ndt::Pose& vehicle,
                std::vector<Eigen::Vector3f>& points_m) {
  std::vector<Shot> shots(drive.lidar().traits().shots_per_packet);
  drive.lidar().aim(drive.packet_utc_ns(packet), shots);
  const std::vector<Echo> echoes = drive.fire_from(packet, vehicle);
  const ndt::Pose mounting = kSensorMounting.pose();
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (echoes[i].range_m <= 0.0) continue;
    const Eigen::Vector3d point_m = shots[i].origin_m + echoes[i].range_m * shots[i].direction();
    points_m.emplace_back((mounting * point_m).cast<float>());
  }
}

}  // namespace

void write_still_scans(const Drive& drive, const std::filesystem::path& folder, const Progress& progress) {
  std::filesystem::create_directories(folder / "scans");
  std::vector<platform::StampedPose> truth;
  std::size_t packet = 0;
  const auto turn_of = [&drive](std::size_t p) { return drive.packet_utc_ns(p) / kTurn_ns; };
  const std::int64_t last_turn = turn_of(drive.packets());
  for (std::int64_t turn = turn_of(0) + 1; turn < last_turn; ++turn) {
    while (turn_of(packet) < turn) ++packet;
    const std::int64_t end_utc_ns = (turn + 1) * kTurn_ns;
    const ndt::Pose vehicle =
        drive.vehicle().pose_at(1e-9 * static_cast<double>(end_utc_ns - kDriveStart_utc_ns));
    std::vector<Eigen::Vector3f> points_m;
    for (; turn_of(packet) == turn; ++packet) add_points(drive, packet, vehicle, points_m);
    platform::write_pcd_records(folder / "scans" / fmt::format("{:04}.pcd", truth.size()),
                                platform::kPositionMembers, std::as_bytes(std::span(points_m)),
                                sizeof(Eigen::Vector3f));
    truth.push_back({end_utc_ns, vehicle});
    progress(static_cast<double>(packet) / static_cast<double>(drive.packets()));
  }
  progress(1.0);
  platform::write_tum(folder / "scans.tum", truth);
}

}  // namespace landfix::tools::simulator
