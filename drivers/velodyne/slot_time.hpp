// How long a VLS-128 takes for one firing slot: its firmware decides (2.665 to 2.89 us), and only the times
// of the packets tell.
#pragma once

#include <cstdint>

namespace landfix::drivers::velodyne {

/// A packet spans a known number of slots, so the spacing of packets is measured; gaps are left out. The
/// stamps are whole microseconds and dithered, so they are averaged: evenly at first, then over the last 256.
class SlotTime {
 public:
  /// Takes the time from one packet to the next, which span `slots` each.
  void update(std::int64_t spacing_ns, int slots) noexcept {
    const double slot_us = static_cast<double>(spacing_ns) * 1e-3 / slots;
    if (slot_us < kShortest_us || slot_us > kLongest_us) return;
    if (packets_ < kMostPackets) ++packets_;
    us_ += (slot_us - us_) / packets_;
  }

  [[nodiscard]] double us() const noexcept { return us_; }

 private:
  static constexpr double kShortest_us = 2.4;
  static constexpr double kLongest_us = 3.2;
  static constexpr int kMostPackets = 256;

  double us_ = 2.665;  ///< the manual's (63-9483 Rev A), until packets have been seen
  int packets_ = 0;
};

}  // namespace landfix::drivers::velodyne
