// How one thread wakes another that has nothing to do: a file descriptor that counts (eventfd). Ringing never
// waits, and a ring while the other looks for work ends its next wait at once.
#pragma once

#include <cstdint>

#include "platform/file_descriptor.hpp"

namespace landfix::platform {

class Doorbell {
 public:
  /// Throws std::runtime_error where the system has no descriptor left.
  Doorbell();

  /// For whoever has left something to do.
  void ring() noexcept;
  /// For the sleeper, which looks for work after each wait: until a ring since the last wait, or until
  /// `deadline_mono_ns`, whichever is first; may wake for nothing.
  void wait(std::int64_t deadline_mono_ns) noexcept;

 private:
  FileDescriptor event_;
};

}  // namespace landfix::platform
