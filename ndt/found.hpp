// What a search over the map says of a vehicle that it has found and followed since.
#pragma once

#include <cstdint>

#include "ndt/motion.hpp"
#include "ndt/pose.hpp"

namespace landfix::ndt {

struct Found {
  StampedPose at;
  Velocity velocity = Velocity::Zero();
  std::uint64_t searched = 0;  ///< number of the sweep that it was found with
};

}  // namespace landfix::ndt
