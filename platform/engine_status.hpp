// The running engine at a moment, as plain values: what metrics, `landfix top` and the log are made of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/sweep.hpp"
#include "ndt/localizer.hpp"
#include "platform/bus_status.hpp"
#include "platform/gnss.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/odometry.hpp"
#include "platform/stage.hpp"

namespace landfix::platform {

/// Up to which durations are counted; what is longer is in the count alone.
inline constexpr std::array<double, 18> kDurationBounds_s{1e-6, 1e-5, 2e-5,   5e-5, 1e-4, 2e-4,
                                                          5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 5e-3,
                                                          1e-2, 2e-2, 5e-2,   1e-1, 2e-1, 1.0};

/// Durations of a stage since the start.
struct DurationSummary {
  std::uint64_t count = 0;
  double sum_s = 0.0;                                            ///< right to 0.8 %
  std::array<std::uint64_t, kDurationBounds_s.size()> within{};  ///< of kDurationBounds_s, cumulative
  std::array<double, 4> percentiles_s{};                         ///< 50, 90, 99, 99.9; 0 if there are none
  double max_s = 0.0;
};
/// `count` and `within` are of one look, however the histogram grows meanwhile.
[[nodiscard]] DurationSummary summarise(const LatencyHistogram& histogram);

struct ThreadStatus {
  std::string name;
  bool advances = true;  ///< its heartbeat is younger than its watchdog allows
  std::uint64_t page_faults = 0;
  std::uint64_t heap_calls = 0;
};

struct EngineStatus {
  std::string version;
  std::string sensor;
  double uptime_s = 0.0;
  std::uint64_t resident_bytes = 0;
  bool heap_is_counted = true;

  // The last pose.
  ndt::State state = ndt::State::init;
  drivers::TimeSource time_source = drivers::TimeSource::receive;
  std::int64_t stamp_utc_ns = 0;
  ndt::Pose pose = ndt::Pose::Identity();  ///< map <- vehicle
  double speed_mps = 0.0;
  double sigma_along_m = 0.0;
  double sigma_cross_m = 0.0;
  double sigma_yaw_rad = 0.0;
  double score = 0.0;  ///< 0 to 1
  int iterations = 0;
  std::uint64_t points = 0;  ///< after the filter

  // Since the start.
  std::uint64_t packets = 0;  ///< taken
  std::uint64_t packets_dropped_kernel = 0;
  std::uint64_t packets_dropped_ring = 0;
  std::uint64_t packets_truncated = 0;
  std::uint64_t packets_rejected = 0;  ///< by the decoder
  std::uint64_t packets_lost = 0;      ///< between the sensor and here
  std::uint64_t packets_strangers = 0;
  std::uint64_t receive_errors = 0;  ///< calls that the system refused
  std::uint64_t sweeps = 0;
  std::uint64_t sweeps_missing = 0;
  std::uint64_t sweeps_skipped = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t fixes_dropped = 0;  ///< that tx or house had no room for
  std::uint64_t points_dropped = 0;
  std::uint64_t answers_late = 0;
  std::uint64_t clock_steps = 0;
  std::uint64_t sensor_restarts = 0;

  OdometryStatus odometry;
  GnssCounters gnss;

  BusStatus bus;
  std::uint64_t poses_saturated = 0;
  std::array<DurationSummary, kStageCount> stages{};
  std::vector<ThreadStatus> threads;
};

}  // namespace landfix::platform
