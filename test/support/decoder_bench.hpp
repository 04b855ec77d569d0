// A decoder with its storage, to put packets in and look at the points that come out.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/make_decoder.hpp"

namespace landfix::test {

inline constexpr std::int64_t kHourUtcNs = 1'700'002'800'000'000'000;  ///< a full hour
/// Packets say 1 s past it and are received a millisecond later.
inline constexpr std::uint32_t kTopOfHourUs = 1'000'000;
inline constexpr std::int64_t kReceiveUtcNs = kHourUtcNs + 1'001'000'000;

class DecoderBench {
 public:
  /// `capacity`: points of one sweep.
  explicit DecoderBench(std::string_view model, const drivers::DecoderOptions& options = {},
                        std::size_t capacity = 100'000, const drivers::Calibration& calibration = {})
      : DecoderBench(drivers::make_decoder(*drivers::find_sensor_model(model), options, calibration),
                     capacity) {}
  DecoderBench(const drivers::AnyDecoder& decoder, std::size_t capacity)
      : storage_(2 * capacity), sweeps_(storage_), decoder_(decoder) {}

  /// Remembers a sweep that the packet completed.
  drivers::DecodeResult decode(std::span<const std::byte> payload,
                               std::int64_t receive_utc_ns = kReceiveUtcNs) {
    const auto result = decoder_.decode({.payload = payload, .receive_utc_ns = receive_utc_ns}, sweeps_);
    if (result.sweep_completed) keep();
    return result;
  }
  bool flush() {
    const bool flushed = decoder_.flush(sweeps_);
    if (flushed) keep();
    return flushed;
  }

  [[nodiscard]] const drivers::StreamCounters& counters() const { return decoder_.counters(); }

  struct SweepCopy {
    std::vector<drivers::Point> points;
    bool complete = false;
    std::int64_t start_utc_ns = 0;
    drivers::TimeSource time_source{};
    std::size_t overflowed = 0;
  };
  [[nodiscard]] const std::vector<SweepCopy>& swept() const { return swept_; }
  /// Of the sweep that is being filled.
  [[nodiscard]] std::span<const drivers::Point> points() { return sweeps_.current().points(); }
  /// Of all sweeps, in order.
  [[nodiscard]] std::vector<drivers::Point> all_points() {
    std::vector<drivers::Point> all;
    for (const SweepCopy& sweep : swept_) all.insert(all.end(), sweep.points.begin(), sweep.points.end());
    all.insert(all.end(), points().begin(), points().end());
    return all;
  }

 private:
  void keep() {
    const drivers::Sweep& sweep = sweeps_.completed();
    swept_.push_back({.points = {sweep.points().begin(), sweep.points().end()},
                      .complete = sweep.complete(),
                      .start_utc_ns = sweep.start_utc_ns(),
                      .time_source = sweep.time_source(),
                      .overflowed = sweep.overflowed()});
  }

  std::vector<drivers::Point> storage_;
  drivers::SweepPair sweeps_;
  drivers::AnyDecoder decoder_;
  std::vector<SweepCopy> swept_;
};

}  // namespace landfix::test
