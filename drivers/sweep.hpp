// A sweep: the points of one revolution, in memory that the caller lends.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "drivers/point.hpp"

namespace landfix::drivers {

/// Whose clock the times of a sweep come from.
enum class TimeSource : std::uint8_t {
  sensor,   ///< the sensor's clock is synchronised to UTC
  receive,  ///< it is not: its spacing is kept, its offset comes from the times of receipt
};

[[nodiscard]] constexpr std::string_view to_string(TimeSource source) noexcept {
  return source == TimeSource::sensor ? "sensor" : "receive";
}

/// Points in the order of the packets. Never grows: a point that does not fit is counted. Whoever uses points
/// as they come may forget them, and then needs room for a packet's alone.
class Sweep {
 public:
  Sweep() = default;
  explicit Sweep(std::span<Point> storage) noexcept : storage_(storage) {}

  /// Empties the sweep. `start_utc_ns`: time of its first firing, Unix nanoseconds UTC; `at_cut`: it begins
  /// where the azimuth passed the cut, not in the middle of a turn.
  void begin(std::int64_t start_utc_ns, bool at_cut, TimeSource time_source) noexcept {
    size_ = 0;
    is_empty_ = true;
    overflowed_ = 0;
    last_time_s_ = 0.0F;
    start_utc_ns_ = start_utc_ns;
    complete_ = at_cut;
    lost_packets_ = 0;
    time_source_ = time_source;
  }

  void push(const Point& point) noexcept {
    if (size_ == storage_.size()) {
      ++overflowed_;
      complete_ = false;
      return;
    }
    storage_[size_++] = point;
    is_empty_ = false;
    last_time_s_ = std::max(last_time_s_, point.time_s);
  }

  /// Where the next points go, for a decoder that writes many at once and then says how many of them count,
  /// and the latest of their times. What is not written here goes through `push`, which counts what does not
  /// fit.
  [[nodiscard]] std::span<Point> unused() noexcept { return storage_.subspan(size_); }
  void take(std::size_t count, float latest_time_s) noexcept {
    size_ += count;
    if (count == 0) return;
    is_empty_ = false;
    last_time_s_ = std::max(last_time_s_, latest_time_s);
  }

  /// Those that are here have been used: their room is free again. What is known of the sweep as a whole
  /// stays.
  void forget_points() noexcept { size_ = 0; }

  /// A firing has come that was earlier than the first: the sweep begins by so much earlier.
  void begin_earlier(std::int64_t by_ns) noexcept {
    const auto by_s = static_cast<float>(static_cast<double>(by_ns) * 1e-9);
    for (Point& point : storage_.first(size_)) point.time_s += by_s;
    if (!is_empty_) last_time_s_ += by_s;
    start_utc_ns_ -= by_ns;
  }

  /// Something of this turn is missing: it did not end at the cut.
  void mark_partial() noexcept { complete_ = false; }
  /// Packets of this turn have not come; `recover_packet` takes one back that was only late.
  void lose_packets(std::uint32_t count) noexcept { lost_packets_ += count; }
  void recover_packet() noexcept { lost_packets_ -= lost_packets_ > 0 ? 1 : 0; }

  /// Those not forgotten.
  [[nodiscard]] std::span<const Point> points() const noexcept { return storage_.first(size_); }
  /// No point has come, forgotten or not.
  [[nodiscard]] bool empty() const noexcept { return is_empty_; }
  [[nodiscard]] std::int64_t start_utc_ns() const noexcept { return start_utc_ns_; }
  /// Time of the last point: the time that the sweep's pose holds for.
  [[nodiscard]] std::int64_t end_utc_ns() const noexcept {
    return start_utc_ns_ + static_cast<std::int64_t>(static_cast<double>(last_time_s_) * 1e9);
  }
  [[nodiscard]] float last_time_s() const noexcept { return last_time_s_; }
  /// A whole turn, from cut to cut, and no packet of it missing.
  [[nodiscard]] bool complete() const noexcept { return complete_ && lost_packets_ == 0; }
  /// Packets that should have been part of it.
  [[nodiscard]] std::uint32_t lost_packets() const noexcept { return lost_packets_; }
  [[nodiscard]] TimeSource time_source() const noexcept { return time_source_; }
  [[nodiscard]] std::size_t overflowed() const noexcept { return overflowed_; }

 private:
  std::span<Point> storage_;
  std::size_t size_ = 0;
  bool is_empty_ = true;
  std::size_t overflowed_ = 0;
  std::int64_t start_utc_ns_ = 0;
  float last_time_s_ = 0.0F;
  std::uint32_t lost_packets_ = 0;
  bool complete_ = false;
  TimeSource time_source_ = TimeSource::receive;
};

/// The sweep that fills and the one that was filled before it. A packet may hold the end of one turn and the
/// start of the next; the completed sweep stays valid until the next cut.
class SweepPair {
 public:
  /// `storage` is split in two halves, each the capacity of one sweep.
  explicit SweepPair(std::span<Point> storage) noexcept
      : current_(storage.first(storage.size() / 2)),
        completed_(storage.subspan(storage.size() / 2, storage.size() / 2)) {}

  [[nodiscard]] Sweep& current() noexcept { return current_; }
  [[nodiscard]] const Sweep& completed() const noexcept { return completed_; }

  /// The current sweep becomes the completed one.
  void cut() noexcept { std::swap(current_, completed_); }

 private:
  Sweep current_;
  Sweep completed_;
};

}  // namespace landfix::drivers
