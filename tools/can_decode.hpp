// Poses from a log of CAN frames or from an interface, their protection checked.
#pragma once

#include <cstdint>
#include <string>

#include "platform/configuration.hpp"

namespace landfix::tools {

struct CanDecodeArguments {
  std::string source;     ///< a log, or the name of an interface
  std::string interface;  ///< of a log's; empty: the first with one of our frames
  std::uint32_t base_id = platform::CanSettings{}.base_id;
  std::uint64_t count = 0;  ///< poses after which to end; 0: no limit
  double seconds = 0.0;     ///< of an interface, after which to end; 0: no limit
  bool json = false;
};

/// Prints what it finds; of an interface as it comes, until a limit or Ctrl-C. Throws where it finds nothing.
void decode_can(const CanDecodeArguments& arguments);

}  // namespace landfix::tools
