// One frame as a group of its own.
#pragma once

#include <cstdint>
#include <span>

#include "platform/can_frame.hpp"

namespace landfix::test {

[[nodiscard]] inline bool send_frame(platform::FrameSink& sink, const platform::CanFrame& frame,
                                     std::int64_t stamp_utc_ns) {
  return sink.send(std::span(&frame, 1), stamp_utc_ns) == 1;
}

}  // namespace landfix::test
