#include "platform/heap_counter.hpp"

namespace landfix::platform {

constinit thread_local HeapCounter::Thread HeapCounter::thread_{};
constinit bool HeapCounter::available_ = false;

// Not in the header: compilers know malloc, take it not to look at our variables, and where they see these
// assignments beside it they drop them.
void HeapCounter::arm() noexcept { thread_.armed = true; }
void HeapCounter::disarm() noexcept { thread_.armed = false; }
std::uint64_t HeapCounter::calls() noexcept { return thread_.calls; }
std::uint64_t HeapCounter::locks() noexcept { return thread_.locks; }

}  // namespace landfix::platform
