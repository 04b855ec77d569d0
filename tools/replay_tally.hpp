// How the sweeps of a replay ended, in fixed memory however many there are.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "ndt/localizer.hpp"
#include "platform/sweep_result.hpp"

namespace landfix::tools {

class ReplayTally {
 public:
  void add(const platform::SweepResult& sweep) noexcept {
    ++by_state_[static_cast<std::size_t>(sweep.fix.state)];
    time_source_ = sweep.time_source;
    ++published_;
    if (sweep.missing) return;
    ++came_;
    if (!sweep.complete) ++partial_;
    iterations_ += static_cast<double>(sweep.fix.match.iterations);
    points_ += static_cast<double>(sweep.points_filtered);
  }

  [[nodiscard]] std::size_t count(ndt::State state) const noexcept {
    return by_state_[static_cast<std::size_t>(state)];
  }
  [[nodiscard]] std::size_t came() const noexcept { return came_; }
  [[nodiscard]] std::size_t missing() const noexcept { return published_ - came_; }
  [[nodiscard]] std::size_t partial() const noexcept { return partial_; }  ///< came, but no whole turn
  /// Whose clock the stamps come from, at the end.
  [[nodiscard]] drivers::TimeSource time_source() const noexcept { return time_source_; }
  // Of those that came; NaN where none did.
  [[nodiscard]] double iterations_mean() const noexcept { return mean(iterations_); }
  [[nodiscard]] double points_mean() const noexcept { return mean(points_); }  ///< after the filter

 private:
  [[nodiscard]] double mean(double sum) const noexcept {
    return came_ != 0 ? sum / static_cast<double>(came_) : std::numeric_limits<double>::quiet_NaN();
  }

  std::array<std::size_t, 6> by_state_{};
  std::size_t published_ = 0;
  std::size_t came_ = 0;
  std::size_t partial_ = 0;
  double iterations_ = 0.0;
  double points_ = 0.0;
  drivers::TimeSource time_source_ = drivers::TimeSource::receive;
};

}  // namespace landfix::tools
