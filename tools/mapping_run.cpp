#include "tools/mapping_run.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/trajectory.hpp"
#include "tools/cpu_clock.hpp"

namespace landfix::tools {
namespace {

[[nodiscard]] std::string row_of(const MappedSweep& sweep) {
  const Eigen::Vector3d& position_m = sweep.at.pose.translation();
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(sweep.at.pose.linear());
  const ndt::MatchResult& match = sweep.match;
  return fmt::format(
      "{}.{:09},{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},{:.3f},{},{:.6f},{:.4f},{:.4f},{},{:.4f},{},{:.3f}"
      "\n",
      sweep.at.stamp_utc_ns / 1'000'000'000, sweep.at.stamp_utc_ns % 1'000'000'000, position_m.x(),
      position_m.y(), position_m.z(), angles.roll_rad / kRadians_per_deg, angles.pitch_rad / kRadians_per_deg,
      angles.yaw_rad / kRadians_per_deg, sweep.travelled_m, match.iterations, sweep.fitness_score_m2,
      match.transformation_probability, match.nearest_voxel_likelihood, match.points, match.matched_share(),
      sweep.added ? 1 : 0, sweep.match_ms);
}

constexpr std::string_view kMetricsHeader =
    "stamp_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg,travelled_m,iterations,fitness_score_m2,"
    "transformation_probability,nearest_voxel_likelihood,points,matched_share,added,match_ms\n";

}  // namespace

MappingSettings study_mapping() {
  MappingSettings settings;
  settings.mapper.resolution_m = 1.0;
  settings.mapper.add_after_m = 1.0;
  settings.mapper.source = ndt::PointSource::survey;
  settings.filter.leaf_m = 2.0;
  settings.deskew = false;
  return settings;
}

MappingRun::MappingRun(const MappingSettings& settings, const std::filesystem::path& folder)
    : settings_(settings),
      folder_(folder),
      mapper_(settings.mapper, settings.first_pose),
      filter_(settings.filter, ndt::Matcher::kMaxPoints),
      cloud_(folder / "map.pcd", platform::kPositionMembers) {}

/// The velocity of a sweep is known once it has been matched: the second time it is undistorted with its own.
void MappingRun::add(const drivers::Sweep& sweep) {
  const int passes = settings_.deskew ? 2 : 1;
  MappedSweep mapped{.at = {.stamp_utc_ns = sweep.end_utc_ns()}};
  ndt::Velocity velocity = settings_.deskew ? mapper_.velocity() : ndt::Velocity::Zero();
  for (int pass = 0; pass < passes; ++pass) {
    undistort(sweep, velocity);
    mapped.match_ms += cpu_ms_of([&] { mapped.match = match(points_m_, sweep.end_utc_ns()); });
    mapped.at.pose = mapped.match.pose;
    velocity = mapper_.velocity_to(mapped.at);
  }
  settle(std::move(mapped), points_m_);
}

void MappingRun::add(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns) {
  MappedSweep mapped{.at = {.stamp_utc_ns = stamp_utc_ns}};
  mapped.match_ms = cpu_ms_of([&] { mapped.match = match(points_m, stamp_utc_ns); });
  mapped.at.pose = mapped.match.pose;
  settle(std::move(mapped), points_m);
}

ndt::MatchResult MappingRun::match(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns) {
  filter_.clear();
  filter_.add(points_m, {});
  filtered_m_ = filter_.finish();
  return mapper_.match(filtered_m_, stamp_utc_ns);
}

void MappingRun::undistort(const drivers::Sweep& sweep, const ndt::Velocity& velocity) {
  deskew_.begin(sweep.start_utc_ns(), velocity, settings_.sensor_pose);
  const Eigen::Isometry3f to_end = deskew_.from_start(sweep.end_utc_ns()).cast<float>();
  points_m_.clear();
  for (const drivers::Point& point : sweep.points()) {
    points_m_.push_back(to_end * deskew_.to_start(point, 0.0F));
  }
}

void MappingRun::settle(MappedSweep sweep, std::span<const Eigen::Vector3f> points_m) {
  // Against the map that it was matched to, before it is added.
  if (fitness_) sweep.fitness_score_m2 = (*fitness_)(filtered_m_, sweep.at.pose);
  sweep.added = mapper_.settle(sweep.at);
  sweep.travelled_m = mapper_.travelled_m();
  if (sweep.added) {
    mapper_.add(points_m, sweep.at.pose);
    fitness_.emplace(mapper_.map());
    for (const Eigen::Vector3f& point_m : points_m) {
      const Eigen::Vector3f placed_m = (sweep.at.pose * point_m.cast<double>()).cast<float>();
      cloud_.write(std::as_bytes(std::span(&placed_m, 1)));
    }
    map_points_ += points_m.size();
  }
  sweeps_.push_back(sweep);
}

void MappingRun::finish() {
  cloud_.commit();
  std::vector<ndt::StampedPose> trajectory;
  std::string metrics(kMetricsHeader);
  for (const MappedSweep& sweep : sweeps_) {
    trajectory.push_back(sweep.at);
    metrics += row_of(sweep);
  }
  platform::write_tum(folder_ / "trajectory.tum", trajectory);
  platform::write_file(folder_ / "metrics.csv", metrics);
}

}  // namespace landfix::tools
