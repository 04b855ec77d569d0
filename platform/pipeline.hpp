// The main job, assembled: packets in, poses out. decode -> deskew and filter -> match -> publish. Points are
// deskewed and filtered packet by packet, so that a sweep's last one leaves little but the match to do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/any_decoder.hpp"
#include "drivers/decoder.hpp"
#include "drivers/sweep.hpp"
#include "ndt/deadline.hpp"
#include "ndt/localizer.hpp"
#include "ndt/motion.hpp"
#include "ndt/pose.hpp"
#include "ndt/pose_guess.hpp"
#include "ndt/scan_filter.hpp"
#include "ndt/voxel_map.hpp"
#include "platform/can_frame.hpp"
#include "platform/gnss.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/map_aids.hpp"
#include "platform/odometry.hpp"
#include "platform/packet_source.hpp"
#include "platform/pose_publisher.hpp"
#include "platform/stage.hpp"
#include "platform/sweep_result.hpp"
#include "platform/sweep_schedule.hpp"

namespace landfix::platform {

struct PipelineSettings {
  std::uint16_t port = 0;                         ///< of the sensor's data packets; others are counted
  std::uint16_t telemetry_port = 0;               ///< of its other packets; 0: none
  std::uint32_t sensor_address = 0;               ///< IPv4, host byte order; 0: whoever sends
  std::int64_t longest_period_ns = 200'000'000;   ///< of a sweep, at the sensor's slowest speed
  ndt::Pose sensor_pose = ndt::Pose::Identity();  ///< vehicle <- sensor
  ndt::FilterSettings filter;
  std::size_t filter_capacity = ndt::Matcher::kMaxPoints;  ///< points after the filter
  bool deskew = true;
  ndt::LocalizerSettings localizer{};
  /// map <- vehicle; nothing: it is looked for, where `gnss` says, else in `initial_area`, else anywhere.
  std::optional<ndt::Pose> initial_pose{};
  std::optional<ndt::PoseGuess> initial_area{};
  PublishSettings publish;
  OdometrySettings odometry{};
  GnssSettings gnss{};
};

/// What a sweep that a packet completes may cost, where others wait.
struct SweepOrders {
  bool skip_match = false;   ///< predict it instead
  ndt::Deadline deadline{};  ///< of its match
};

struct PipelineCounters {
  std::uint64_t packets = 0;        ///< decoded, rejected or telemetry
  std::uint64_t other_ports = 0;    ///< not decoded
  std::uint64_t other_senders = 0;  ///< to the sensor's port, not from its address: not decoded
  drivers::StatusCounts by_status{};
  std::uint64_t points_overflowed = 0;  ///< did not fit the sweep
  std::uint64_t points_unfiltered = 0;  ///< did not fit the filter, or were not finite
  std::uint64_t pairs_dropped = 0;      ///< of a point and a voxel, for want of room in the matcher
  std::uint64_t answers_late = 0;       ///< of the search for a lost vehicle

  [[nodiscard]] std::uint64_t rejected() const noexcept { return drivers::rejected(by_status); }
};

/// Allocates in its constructor and never after.
class Pipeline {
 public:
  /// A sweep's points are filtered as they come and forgotten: it never holds more than a packet's (OS1-128:
  /// 2048).
  static constexpr std::size_t kMaxPointsPerPacket = 1 << 14;

  /// The memory that `map` views, `bus` and `aids` must outlive it; without a bus nothing is published.
  Pipeline(const PipelineSettings& settings, const drivers::AnyDecoder& decoder, const ndt::VoxelMap& map,
           FrameSink* bus, const MapAids& aids = {});

  /// Part of the set-up: filters, matches and encodes once, with points of the map around the initial pose,
  /// so that the first sweep finds code and memory in place. Leaves no trace.
  void warm_up() noexcept;

  /// Takes one packet; what came of the sweep that it completed, if it did.
  [[nodiscard]] std::optional<SweepResult> process(const UdpPacket& packet,
                                                   const SweepOrders& orders = {}) noexcept;
  /// What is to be said, by now, of a sweep that has not come; to be asked before each packet, with its time
  /// of receipt, and while none comes with the clock that packets are stamped by, until there is nothing. A
  /// sweep is missing half a period after it was due. For a second they are PREDICTED, then NO_DATA twice a
  /// second; what is left of a sweep that was begun is then dropped. Nothing before the first sweep.
  [[nodiscard]] std::optional<SweepResult> predict_missing(std::int64_t now_utc_ns) noexcept;
  /// Takes what the vehicle's bus has said, by its times of receipt; to be told before a packet that came
  /// later.
  void listen(FrameSource& bus, std::int64_t now_utc_ns) noexcept {
    for (StampedFrame frame; bus.next(frame, now_utc_ns);) {
      odometry_.add(frame.frame, frame.stamp_utc_ns);
      gnss_.add(frame.frame, frame.stamp_utc_ns);
    }
  }
  /// Where nobody else searches: as much of it as is waiting, in its own time.
  void search() const noexcept {
    while (aids_.search != nullptr && aids_.search->work()) continue;
  }
  /// At the end of the packets: what came of the last sweep, if any is begun.
  [[nodiscard]] std::optional<SweepResult> finish() noexcept;

  [[nodiscard]] const PipelineCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] const PublishCounters& publish_counters() const noexcept { return publisher_.counters(); }
  [[nodiscard]] const drivers::StreamCounters& stream_counters() const noexcept {
    return decoder_.counters();
  }
  [[nodiscard]] const Odometry& odometry() const noexcept { return odometry_; }
  [[nodiscard]] const Gnss& gnss() const noexcept { return gnss_; }
  [[nodiscard]] const LatencyHistogram& durations(Stage stage) const noexcept {
    return durations_[static_cast<std::size_t>(stage)];
  }

 private:
  [[nodiscard]] SweepResult localize(const drivers::Sweep& sweep, const SweepOrders& orders) noexcept;
  void drop_begun_sweep() noexcept;
  [[nodiscard]] std::optional<ndt::MeasuredMotion> motion_to(std::int64_t stamp_utc_ns) const noexcept;
  [[nodiscard]] ndt::Velocity velocity_at(std::int64_t stamp_utc_ns) const noexcept;
  void check_odometry(const ndt::Fix& fix) noexcept;
  void filter_new_points(const drivers::Sweep& sweep) noexcept;
  [[nodiscard]] std::span<const Eigen::Vector3f> finish_filter(std::int64_t end_utc_ns) noexcept;
  [[nodiscard]] bool is_late(std::int64_t stamp_utc_ns) noexcept;
  void publish(const SweepResult& result) noexcept;
  [[nodiscard]] ndt::Fix fix_of(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                                const SweepOrders& orders) noexcept;
  [[nodiscard]] std::optional<ndt::PoseGuess> known_area(std::int64_t stamp_utc_ns) noexcept;
  void record(Stage stage, std::int64_t duration_ns) noexcept;

  PipelineSettings settings_;
  drivers::AnyDecoder decoder_;
  std::vector<drivers::Point> points_;
  drivers::SweepPair sweeps_;
  ndt::Deskew deskew_;
  ndt::ScanFilter filter_;
  bool is_filtering_ = false;  ///< the filter has points of the current sweep
  ndt::Localizer localizer_;
  SweepSchedule schedule_;
  Odometry odometry_;
  Gnss gnss_;
  std::optional<ndt::StampedPose> last_tracked_;  ///< of the last sweep, if it was TRACKING
  std::int64_t seen_utc_ns_ = 0;
  std::int64_t told_utc_ns_ = 0;  ///< the stamp of the last result, of a sweep that came or not
  drivers::TimeSource time_source_ = drivers::TimeSource::receive;  ///< of the last sweep
  PosePublisher publisher_;
  MapAids aids_;
  std::optional<ndt::PoseGuess> area_;  ///< of the current sweep, if it is looked for
  PipelineCounters counters_;
  SweepTimes times_;            ///< of the current sweep
  std::int64_t decode_ns_ = 0;  ///< spent on the packets of the current sweep
  std::int64_t filter_ns_ = 0;
  std::array<LatencyHistogram, kStageCount> durations_{};
};

}  // namespace landfix::platform
