// One line of a CAN log.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "platform/candump_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  const auto logged = parse_candump_line({reinterpret_cast<const char*>(data), size});
  if (!logged) return 0;
  const std::uint32_t max_id = logged->frame.extended ? 0x1FFFFFFF : 0x7FF;
  if (!is_can_length(logged->frame.length, logged->frame.fd) || logged->frame.id > max_id ||
      logged->stamp_utc_ns < 0)
    std::abort();
  return 0;
}
