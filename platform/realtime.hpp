// What a thread asks of the kernel to be on time: memory that stays, a place before the others, a core.
// Without the rights it does without: each says in one sentence what is missing and how to give it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <pthread.h>

#include "platform/realtime_settings.hpp"

namespace landfix::platform {

/// What could not be had, as a sentence for the log; nothing where all is as asked.
using Missing = std::optional<std::string>;

/// Keeps all memory of this moment in memory, program and libraries included: to be called once everything is
/// allocated and before any ordinary thread has begun, whose 8 MiB of stack would be kept too. What comes
/// later is not kept (a RealtimeThread keeps its own stack), so that a pool of threads elsewhere costs
/// nothing.
[[nodiscard]] Missing lock_memory();

/// The heap gives nothing back to the kernel and takes no memory aside from it: what was touched stays
/// touched.
void keep_heap_pages() noexcept;

/// Priority of SCHED_FIFO, or 0 for SCHED_OTHER; `thread` is how the sentence calls it.
[[nodiscard]] Missing set_priority(pthread_t id, std::string_view thread, int priority);
/// Nothing happens for core -1.
[[nodiscard]] Missing set_core(pthread_t id, std::string_view thread, int core);

/// For the calling thread: timers that are not gathered with others.
void use_precise_timers() noexcept;
/// For the calling thread: denormal numbers count as 0, instead of taking many times as long.
void flush_denormals() noexcept;

}  // namespace landfix::platform
