// What a target is run with where the command line does not say otherwise (CMakeLists.txt).
#include <cstddef>
#include <string>
#include <vector>

/// Called by libFuzzer before it reads its options, of which the last one counts.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  static std::vector<std::string> options{LANDFIX_FUZZ_OPTIONS};
  static std::vector<char*> arguments(*argv, *argv + *argc);
  for (std::string& option : options) arguments.insert(arguments.begin() + 1, option.data());
  *argc = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  *argv = arguments.data();
  return 0;
}

/// What has been freed need not be kept for thousands of inputs, nor all callers of an allocation be told.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming): AddressSanitizer's
extern "C" const char* __asan_default_options() { return "quarantine_size_mb=8:malloc_context_size=8"; }
