// A DBC file.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "fuzz/fuzz_file.hpp"
#include "platform/dbc_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix;
  static const std::string sound =
      "VERSION \"\"\nBO_ 170 WHEELS: 8 X\n SG_ FR M : 6|15@0+ (0.01,-67.67) [0|250] \"kph\" X\n"
      "CM_ SG_ 170 FR \"wheel\";\nBO_ 2566844885 FAR: 64 X\n SG_ YAW m2 : 8|12@1- (-1.4e-3,2) [-3|3] \"\" "
      "A,B\n";
  try {
    for (const auto& message :
         platform::parse_dbc(test::fuzzed_text(sound, std::span(data, size)), "a.dbc")) {
      for (const auto& signal : message.signals) {
        if (platform::bytes_of(signal.field) > message.bytes) std::abort();
      }
    }
  } catch (const std::runtime_error&) {  // refused, as it should be
  }
  return 0;
}
