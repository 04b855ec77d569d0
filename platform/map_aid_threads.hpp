// The threads of those who work beside the solver: the loader of map tiles, and the searcher for a vehicle
// that does not know where it is. Not real-time: nobody waits for them.
#pragma once

#include <thread>

#include "platform/map_aids.hpp"

namespace landfix::platform {

/// They work for as long as it lives, which is shorter than what `aids` name.
class MapAidThreads {
 public:
  explicit MapAidThreads(const MapAids& aids);

 private:
  std::jthread loader_;
  std::jthread searcher_;
};

}  // namespace landfix::platform
