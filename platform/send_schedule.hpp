// When the next pose goes out on a live bus: at a steady rate, but a sweep's own pose as soon as it is there.
#pragma once

#include <cstdint>

namespace landfix::platform {

/// Times are monotonic nanoseconds. A pose is due a period after the last; a new sweep's is sent at once if
/// at least half a period has gone by. Where one is expected about the time that is due, it is waited for, up
/// to a quarter of a period: at the sweep rate every pose is then a sweep's, and none is sent twice.
class SendSchedule {
 public:
  explicit SendSchedule(double rate_hz) noexcept : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

  /// A sweep's pose has come.
  void take_fix(std::int64_t now_ns) noexcept {
    if (fix_ns_ != kNever) sweep_period_ns_ = now_ns - fix_ns_;
    fix_ns_ = now_ns;
    is_fresh_ = true;
  }

  /// When to look again, at the latest.
  [[nodiscard]] std::int64_t due_ns() const noexcept {
    if (sent_ns_ == kNever) return 0;
    const std::int64_t due = sent_ns_ + period_ns_;
    if (is_fresh_) return sent_ns_ + period_ns_ / 2;
    if (fix_ns_ == kNever || sweep_period_ns_ == 0) return due;
    const std::int64_t until_fix = fix_ns_ + sweep_period_ns_ - due;
    const bool is_about_due = until_fix > -period_ns_ / 2 && until_fix <= period_ns_ / 4;
    return is_about_due ? due + period_ns_ / 4 : due;
  }

  void sent(std::int64_t now_ns) noexcept {
    sent_ns_ = now_ns;
    is_fresh_ = false;
  }

 private:
  static constexpr std::int64_t kNever = -1;

  std::int64_t period_ns_;
  std::int64_t sweep_period_ns_ = 0;  ///< between the last two sweeps' poses; 0: not known
  std::int64_t sent_ns_ = kNever;
  std::int64_t fix_ns_ = kNever;  ///< when the last sweep's pose came
  bool is_fresh_ = false;         ///< it has not been sent
};

}  // namespace landfix::platform
