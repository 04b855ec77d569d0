// Until when a search may go on. The clock comes from above, as this floor has none.
#pragma once

#include <cstdint>

namespace landfix::ndt {

struct Deadline {
  std::int64_t (*now_ns)() noexcept = nullptr;  ///< null: there is no deadline
  std::int64_t at_ns = 0;                       ///< by that clock

  [[nodiscard]] bool has_passed() const noexcept { return now_ns != nullptr && now_ns() >= at_ns; }
};

}  // namespace landfix::ndt
