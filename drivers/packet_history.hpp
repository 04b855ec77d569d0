// The times of the last few packets: whether one has come before.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace landfix::drivers {

/// A network repeats a packet soon or never.
class PacketHistory {
 public:
  [[nodiscard]] bool contains(std::int64_t time_ns) const noexcept {
    return std::ranges::find(times_ns_, time_ns) != times_ns_.end();
  }
  void insert(std::int64_t time_ns) noexcept { times_ns_[next_++ % times_ns_.size()] = time_ns; }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;
  std::array<std::int64_t, 16> times_ns_ = [] {
    std::array<std::int64_t, 16> times_ns{};
    times_ns.fill(kNever);
    return times_ns;
  }();
  std::size_t next_ = 0;
};

}  // namespace landfix::drivers
