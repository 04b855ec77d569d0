// Set-up of the pipeline: the one place where it allocates.
#include "platform/pipeline.hpp"

namespace landfix::platform {

Pipeline::Pipeline(const PipelineSettings& settings, const drivers::AnyDecoder& decoder,
                   const ndt::VoxelMap& map, FrameSink* bus, MapWindow* window)
    : settings_(settings),
      decoder_(decoder),
      points_(2 * settings.points_per_sweep),
      sweeps_(points_),
      filter_(settings.filter, settings.filter_capacity),
      localizer_(map, settings.localizer, settings.initial_pose),
      schedule_(settings.longest_period_ns, static_cast<std::int64_t>(settings.localizer.lost_after_s * 1e9)),
      odometry_(settings.odometry),
      encoder_(settings.can_base_id, settings.can_fd),
      bus_(bus),
      window_(window) {}

}  // namespace landfix::platform
