// What others do with the map, each in its own time, that the solver makes use of.
#pragma once

#include "platform/map_window.hpp"
#include "platform/place_search.hpp"

namespace landfix::platform {

struct MapAids {
  MapWindow* window = nullptr;    ///< each sweep takes its newest map
  PlaceSearch* search = nullptr;  ///< looks anywhere on the map for a vehicle that does not know where it is
};

}  // namespace landfix::platform
