#include "platform/map_loader.hpp"

#include <chrono>
#include <stop_token>

namespace landfix::platform {

MapLoader::MapLoader(MapWindow& window)
    : thread_([&window](const std::stop_token& stop) {
        constexpr std::chrono::milliseconds kPeriod{20};
        for (; !stop.stop_requested(); std::this_thread::sleep_for(kPeriod)) (void)window.load();
      }) {}

}  // namespace landfix::platform
