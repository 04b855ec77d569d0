#include "platform/map_aid_threads.hpp"

#include <chrono>
#include <new>
#include <stop_token>

#include <pthread.h>

namespace landfix::platform {
namespace {

/// Calls `work` until it is to stop: at once again while that says that it had something to do.
template <class Work>
void keep_working(const std::stop_token& stop, std::chrono::milliseconds pause, const Work& work) {
  while (!stop.stop_requested()) {
    if (!work()) std::this_thread::sleep_for(pause);
  }
}

void load_tiles(const std::stop_token& stop, MapWindow& window) {
  ::pthread_setname_np(::pthread_self(), "loader");
  keep_working(stop, std::chrono::milliseconds(20), [&window] { return window.load(); });
}

void search_places(const std::stop_token& stop, PlaceSearch& search) {
  ::pthread_setname_np(::pthread_self(), "searcher");
  try {
    if (!search.is_prepared()) search.prepare();
  } catch (const std::bad_alloc&) {
    return;  // the solver goes on near the last place; its answers are counted as late
  }
  keep_working(stop, std::chrono::milliseconds(10), [&search] { return search.work(); });
}

}  // namespace

MapAidThreads::MapAidThreads(const MapAids& aids) {
  if (aids.window != nullptr)
    loader_ =
        std::jthread([window = aids.window](const std::stop_token& stop) { load_tiles(stop, *window); });
  if (aids.search != nullptr)
    searcher_ =
        std::jthread([search = aids.search](const std::stop_token& stop) { search_places(stop, *search); });
}

}  // namespace landfix::platform
