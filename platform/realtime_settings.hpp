// How the threads on the way of a pose are scheduled: the section [realtime] of the configuration.
#pragma once

#include <cstdint>

namespace landfix::platform {

class TomlSection;

/// When several may run, the one of the highest priority does, at once.
struct ThreadSchedule {
  int priority = 0;  ///< of SCHED_FIFO, 1 to 98; 0: SCHED_OTHER, as every ordinary thread
  int core = -1;     ///< on which alone it runs; -1: any
};

enum class RealtimeMode : std::uint8_t {
  automatic,  ///< as far as the rights reach; what is missing is said
  required,   ///< without the rights it does not start
  off,        ///< ordinary threads, nothing locked
};

/// Receiving comes first, since the kernel's buffer is short; sending is next, since it is brief.
struct RealtimeSettings {
  RealtimeMode mode = RealtimeMode::automatic;
  bool lock_memory = true;
  ThreadSchedule rx{.priority = 80, .core = -1};
  ThreadSchedule solve{.priority = 70, .core = -1};
  ThreadSchedule tx{.priority = 75, .core = -1};
};

/// Throws std::runtime_error with file, line and column.
void read_realtime(TomlSection section, RealtimeSettings& realtime);

}  // namespace landfix::platform
