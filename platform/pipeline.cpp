#include "platform/pipeline.hpp"

#include <utility>

#include "platform/monotonic_clock.hpp"

namespace landfix::platform {
std::optional<SweepResult> Pipeline::process(const UdpPacket& packet, const SweepOrders& orders) noexcept {
  const bool is_telemetry =
      settings_.telemetry_port != 0 && packet.destination_port == settings_.telemetry_port;
  if (packet.destination_port != settings_.port && !is_telemetry) {
    ++counters_.other_ports;
    return std::nullopt;
  }
  if (settings_.sensor_address != 0 && packet.source_address != settings_.sensor_address) {
    ++counters_.other_senders;
    return std::nullopt;
  }
  const std::int64_t began_ns = monotonic_ns();
  if (times_.first_packet_ns == 0) times_.first_packet_ns = began_ns;
  const drivers::DecodeResult decoded = decoder_.decode({packet.payload, packet.receive_utc_ns}, sweeps_);
  decode_ns_ += monotonic_ns() - began_ns;
  ++counters_.packets;
  ++counters_.by_status[static_cast<std::size_t>(decoded.status)];
  std::optional<SweepResult> result;
  if (decoded.sweep_completed) {
    result = localize(sweeps_.completed(), orders);
    schedule_.came(result->seen_utc_ns, packet.receive_utc_ns);
    record(Stage::last_packet, monotonic_ns() - began_ns);
  }
  // Those of the next sweep that the packet holds come after the match, so that its velocity serves them.
  filter_new_points(sweeps_.current());
  sweeps_.current().forget_points();
  return result;
}

std::optional<SweepResult> Pipeline::finish() noexcept {
  if (!decoder_.flush(sweeps_)) return std::nullopt;
  return localize(sweeps_.completed(), {});
}

std::optional<SweepResult> Pipeline::predict_missing(std::int64_t now_utc_ns) noexcept {
  while (const auto missing = schedule_.next_missing(now_utc_ns)) {
    if (missing->is_silence) drop_begun_sweep();
    const auto measured = motion_to(missing->stamp_utc_ns);
    SweepResult result{.fix = missing->is_silence
                                  ? localizer_.wait_for_data(missing->stamp_utc_ns, measured)
                                  : localizer_.predict_missing(missing->stamp_utc_ns, measured),
                       .seen_utc_ns = seen_utc_ns_,
                       .missing = true,
                       .time_source = time_source_};
    if (result.fix.state == ndt::State::init) continue;
    told_utc_ns_ = missing->stamp_utc_ns;
    publish(result);
    return result;
  }
  return std::nullopt;
}

/// Else its points, of long ago, would be matched when the sensor speaks again, and published as the newest.
void Pipeline::drop_begun_sweep() noexcept {
  if (!decoder_.flush(sweeps_)) return;
  times_ = {};
  filter_.clear();
  is_filtering_ = false;
  filter_ns_ = 0;
  decode_ns_ = 0;
}

void Pipeline::filter_new_points(const drivers::Sweep& sweep) noexcept {
  const std::int64_t began_ns = monotonic_ns();
  if (sweep.points().empty()) return;
  if (!std::exchange(is_filtering_, true)) {
    // Measured, or the velocity of the sweep before, as its match has just run.
    const ndt::Velocity velocity =
        settings_.deskew ? velocity_at(sweep.start_utc_ns()) : ndt::Velocity::Zero();
    deskew_.begin(sweep.start_utc_ns(), velocity, settings_.sensor_pose);
  }
  const auto late_s =
      static_cast<float>(static_cast<double>(sweep.start_utc_ns() - deskew_.start_utc_ns()) * 1e-9);
  for (const drivers::Point& point : sweep.points()) filter_.add(deskew_.to_start(point, late_s), point.ring);
  filter_ns_ += monotonic_ns() - began_ns;
}

std::span<const Eigen::Vector3f> Pipeline::finish_filter(std::int64_t end_utc_ns) noexcept {
  const std::int64_t began_ns = monotonic_ns();
  const std::span<Eigen::Vector3f> points_m = filter_.finish();
  const Eigen::Isometry3f to_end = deskew_.from_start(end_utc_ns).cast<float>();
  for (Eigen::Vector3f& point_m : points_m) point_m = to_end * point_m;
  counters_.points_unfiltered += filter_.dropped_points();
  filter_.clear();
  is_filtering_ = false;
  record(Stage::filter, filter_ns_ + monotonic_ns() - began_ns);
  filter_ns_ = 0;
  return points_m;
}

SweepResult Pipeline::localize(const drivers::Sweep& sweep, const SweepOrders& orders) noexcept {
  times_.last_packet_ns = monotonic_ns();
  record(Stage::decode, decode_ns_);
  decode_ns_ = 0;
  filter_new_points(sweep);
  const auto points_m = finish_filter(sweep.end_utc_ns());
  times_.filtered_ns = monotonic_ns();

  const ndt::Fix fix = fix_of(points_m, sweep.end_utc_ns(), orders);
  times_.matched_ns = monotonic_ns();
  record(Stage::match, times_.matched_ns - times_.filtered_ns);

  check_odometry(fix);
  seen_utc_ns_ = sweep.end_utc_ns();
  time_source_ = sweep.time_source();
  SweepResult result{.fix = fix,
                     .seen_utc_ns = seen_utc_ns_,
                     .late = is_late(sweep.end_utc_ns()),
                     .skipped = orders.skip_match,
                     .points_filtered = points_m.size(),
                     .complete = sweep.complete(),
                     .time_source = sweep.time_source(),
                     .times = std::exchange(times_, {})};
  publish(result);
  record(Stage::publish, monotonic_ns() - result.times.matched_ns);
  counters_.points_overflowed += sweep.overflowed();
  counters_.pairs_dropped += fix.match.pairs_dropped;
  return result;
}

ndt::Fix Pipeline::fix_of(std::span<const Eigen::Vector3f> points_m, std::int64_t stamp_utc_ns,
                          const SweepOrders& orders) noexcept {
  if (orders.skip_match) return localizer_.predict_missing(stamp_utc_ns, motion_to(stamp_utc_ns));
  if (aids_.window != nullptr) localizer_.use_map(aids_.window->newest(localizer_.pose().translation()));
  std::optional<ndt::Velocity> undistorted_with;
  if (settings_.deskew) undistorted_with = deskew_.velocity();
  const bool searches = localizer_.wants_search();
  if (searches) {
    area_ = known_area(stamp_utc_ns);
    localizer_.expect_near(area_);
    if (aids_.search != nullptr) localizer_.expect_found(aids_.search->answer());
  }
  ndt::Fix fix =
      localizer_.localize(points_m, stamp_utc_ns, motion_to(stamp_utc_ns), orders.deadline, undistorted_with);
  if (aids_.search == nullptr) return fix;
  if (!localizer_.wants_search()) {
    aids_.search->end();
    return fix;
  }
  if (!searches) area_ = known_area(stamp_utc_ns);
  aids_.search->put({.stamp_utc_ns = stamp_utc_ns,
                     .undistorted_with = undistorted_with.value_or(ndt::Velocity::Zero()),
                     .area = area_},
                    points_m);
  counters_.answers_late = aids_.search->late();
  return fix;
}

/// Where a vehicle that is looked for is said to be.
std::optional<ndt::PoseGuess> Pipeline::known_area(std::int64_t stamp_utc_ns) noexcept {
  std::optional<ndt::PoseGuess> guess = gnss_.guess(schedule_.received(stamp_utc_ns));
  if (guess || localizer_.has_been_found()) return guess;
  return settings_.initial_area;
}

std::optional<ndt::MeasuredMotion> Pipeline::motion_to(std::int64_t stamp_utc_ns) const noexcept {
  // Odometry is by the clock of receipt.
  return odometry_.motion(schedule_.received(localizer_.last_stamp_utc_ns()),
                          schedule_.received(stamp_utc_ns), localizer_.velocity());
}

ndt::Velocity Pipeline::velocity_at(std::int64_t stamp_utc_ns) const noexcept {
  const std::int64_t received_utc_ns = schedule_.received(stamp_utc_ns);
  const auto measured = odometry_.motion(received_utc_ns, received_utc_ns, localizer_.velocity());
  return measured ? measured->velocity : localizer_.velocity();
}

void Pipeline::check_odometry(const ndt::Fix& fix) noexcept {
  constexpr std::int64_t kShortest_ns = 40'000'000;
  constexpr std::int64_t kLongest_ns = 300'000'000;
  if (fix.state != ndt::State::tracking) {
    last_tracked_.reset();
    return;
  }
  const auto before = std::exchange(last_tracked_, fix.at);
  if (!before) return;
  const std::int64_t between_ns = fix.at.stamp_utc_ns - before->stamp_utc_ns;
  if (between_ns < kShortest_ns || between_ns > kLongest_ns) return;
  odometry_.compare(schedule_.received(before->stamp_utc_ns), schedule_.received(fix.at.stamp_utc_ns),
                    ndt::velocity_between(*before, fix.at));
}

/// What a gap cut short ends before the sweeps that were predicted for the gap.
bool Pipeline::is_late(std::int64_t stamp_utc_ns) noexcept {
  constexpr std::int64_t kSetBack_ns = 1'000'000'000;  // more is a clock that was set
  const bool late = stamp_utc_ns < told_utc_ns_ && told_utc_ns_ - stamp_utc_ns < kSetBack_ns;
  if (!late) told_utc_ns_ = stamp_utc_ns;
  return late;
}

void Pipeline::publish(const SweepResult& result) noexcept {
  if (!result.late) publisher_.publish(report_of(result), result.fix.at.stamp_utc_ns);
}

void Pipeline::record(Stage stage, std::int64_t duration_ns) noexcept {
  durations_[static_cast<std::size_t>(stage)].record(duration_ns);
}

}  // namespace landfix::platform
