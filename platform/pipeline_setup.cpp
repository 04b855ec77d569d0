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
      encoder_(settings.can_base_id, settings.can_fd),
      bus_(bus),
      window_(window) {}

}  // namespace landfix::platform
