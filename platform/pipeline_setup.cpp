// Set-up of the pipeline: the one place where it allocates.
#include "ndt/map_middle.hpp"
#include "platform/pipeline.hpp"
#include "platform/pose_frames.hpp"

namespace landfix::platform {

Pipeline::Pipeline(const PipelineSettings& settings, const drivers::AnyDecoder& decoder,
                   const ndt::VoxelMap& map, FrameSink* bus, const MapAids& aids)
    : settings_(settings),
      decoder_(decoder),
      points_(2 * kMaxPointsPerPacket),
      sweeps_(points_),
      filter_(settings.filter, settings.filter_capacity),
      localizer_(map, settings.localizer, settings.initial_pose),
      schedule_(settings.longest_period_ns, static_cast<std::int64_t>(settings.localizer.lost_after_s * 1e9)),
      odometry_(settings.odometry),
      gnss_(settings.gnss, settings.publish.map.projection),
      publisher_(settings.publish, bus),
      aids_(aids) {}

void Pipeline::warm_up() noexcept {
  constexpr double kReach_m = 60.0;
  const ndt::VoxelMap& map = localizer_.map();
  const ndt::Pose to_vehicle =
      settings_.initial_pose.value_or(ndt::make_pose(ndt::middle_m(map.blocks(), map.resolution_m()), {}))
          .inverse();
  ndt::visit_voxels(map, [&](const ndt::Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
    const Eigen::Vector3d point_m = to_vehicle * mean_m;
    if (point_m.norm() < kReach_m) filter_.add(point_m.cast<float>(), 0);
  });
  localizer_.warm_up(filter_.finish());
  filter_.clear();
  (void)PoseFrameEncoder(settings_.publish.can_base_id, settings_.publish.can_fd).encode(PoseReport());
}

}  // namespace landfix::platform
