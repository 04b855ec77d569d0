// A configuration file.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "platform/configuration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)landfix::platform::parse_configuration({reinterpret_cast<const char*>(data), size},
                                                 "/fuzz/landfix.toml");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
