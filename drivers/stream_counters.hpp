// What went wrong on the way from the sensor, since the decoder was made.
#pragma once

#include <cstdint>

namespace landfix::drivers {

struct StreamCounters {
  std::uint64_t lost_packets = 0;  ///< that never came, or too late for their sweep
  std::uint64_t clock_steps = 0;   ///< times that the sensor's or the receiver's clock was set
  std::uint64_t restarts = 0;      ///< of the sensor, as far as its packets tell
};

}  // namespace landfix::drivers
