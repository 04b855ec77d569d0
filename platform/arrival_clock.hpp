// When a packet arrived, by the monotonic clock. The kernel stamps it by the clock of the day, which may be
// set while it waits to be read.
#pragma once

#include <algorithm>
#include <cstdint>

namespace landfix::platform {

class ArrivalClock {
 public:
  /// Both clocks at one moment, after a read from the socket. `is_dry`: the read took all that waited.
  void set(std::int64_t now_utc_ns, std::int64_t now_mono_ns, bool is_dry) noexcept {
    const std::int64_t ahead_ns = now_mono_ns - now_utc_ns;
    const std::int64_t change_ns = ahead_ns - ahead_ns_;
    // What was stamped before the clock was set is told from the rest only by having been read.
    is_doubtful_ = was_set_ && (doubt_remains_ || change_ns > kStep_ns || change_ns < -kStep_ns);
    doubt_remains_ = is_doubtful_ && !is_dry;
    was_set_ = true;
    ahead_ns_ = ahead_ns;
    now_mono_ns_ = now_mono_ns;
  }

  /// Of a packet of that read. It never lies after the read, and in doubt is the read itself.
  [[nodiscard]] std::int64_t arrived_mono_ns(std::int64_t stamp_utc_ns) const noexcept {
    return is_doubtful_ ? now_mono_ns_ : std::min(stamp_utc_ns + ahead_ns_, now_mono_ns_);
  }

 private:
  static constexpr std::int64_t kStep_ns = 1'000'000;  ///< more than clocks are slewed between two reads

  std::int64_t ahead_ns_ = 0;  ///< of the monotonic clock over UTC
  std::int64_t now_mono_ns_ = 0;
  bool was_set_ = false;
  bool is_doubtful_ = false;
  bool doubt_remains_ = false;
};

}  // namespace landfix::platform
