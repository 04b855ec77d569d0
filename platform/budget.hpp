// What landfixd takes and what it is held to, from the configuration alone: threads, memory, rates.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/sensor_model.hpp"
#include "platform/configuration.hpp"

namespace landfix::platform {

struct ThreadBudget {
  std::string_view name;
  int priority = 0;  ///< of SCHED_FIFO; 0: SCHED_OTHER
  int core = -1;     ///< -1: any
  std::size_t stack_bytes = 0;
  double deadline_ms = 0.0;  ///< from one round to the next; 0: none
  std::string_view task;
};

struct MemoryBudget {
  std::string_view name;
  std::uint64_t bytes = 0;
  std::string_view made_of;
};

struct RateBudget {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
};

struct Budget {
  std::vector<ThreadBudget> threads;
  std::vector<MemoryBudget> memory;  ///< without program, libraries and ordinary threads
  std::vector<RateBudget> rates;     ///< the most there are

  [[nodiscard]] std::uint64_t memory_bytes() const noexcept;
};

/// `map_bytes`: of the map's file; a larger one than [map] memory_mib is read through a window.
/// `search_bytes`: of PlaceSearch, if there is one.
[[nodiscard]] Budget budget_of(const Configuration& configuration, const drivers::SensorModel& model,
                               std::uint64_t map_bytes, std::uint64_t search_bytes);

/// Bits of a frame on the wire with the most stuffing there can be and the gap to the next.
[[nodiscard]] std::size_t worst_frame_bits(bool fd) noexcept;

}  // namespace landfix::platform
