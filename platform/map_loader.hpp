// The thread that loads map tiles while the vehicle drives. Not real-time: a window reaches far enough beyond
// the sensor for it to be late.
#pragma once

#include <thread>

#include "platform/map_window.hpp"

namespace landfix::platform {

/// Loads for as long as it lives, which is shorter than `window`.
class MapLoader {
 public:
  explicit MapLoader(MapWindow& window);

 private:
  std::jthread thread_;
};

}  // namespace landfix::platform
