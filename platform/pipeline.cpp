#include "platform/pipeline.hpp"

#include <limits>
#include <numeric>

#include "ndt/motion.hpp"
#include "platform/monotonic_clock.hpp"

namespace landfix::platform {

std::string_view to_string(Stage stage) noexcept {
  constexpr std::array<std::string_view, kStageCount> kNames{"decode", "filter", "match", "publish"};
  return kNames[static_cast<std::size_t>(stage)];
}

std::optional<SweepResult> Pipeline::process(const UdpPacket& packet) noexcept {
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
  const drivers::DecodeResult decoded = decoder_.decode({packet.payload, packet.receive_utc_ns}, sweeps_);
  decode_ns_ += monotonic_ns() - began_ns;
  ++counters_.packets;
  ++counters_.by_status[static_cast<std::size_t>(decoded.status)];
  if (!decoded.sweep_completed) return std::nullopt;
  return localize(sweeps_.completed());
}

std::optional<SweepResult> Pipeline::finish() noexcept {
  if (!decoder_.flush(sweeps_)) return std::nullopt;
  return localize(sweeps_.completed());
}

SweepResult Pipeline::localize(const drivers::Sweep& sweep) noexcept {
  durations_[static_cast<std::size_t>(Stage::decode)].record(decode_ns_);
  decode_ns_ = 0;

  std::int64_t began_ns = monotonic_ns();
  const ndt::Velocity velocity = settings_.deskew ? localizer_.velocity() : ndt::Velocity::Zero();
  const ndt::Deskew deskew(velocity, sweep.last_time_s(), settings_.sensor_pose);
  grid_.clear();
  for (const drivers::Point& point : sweep.points()) grid_.add(deskew(point));
  const auto points_m = grid_.finish();
  record(Stage::filter, began_ns);

  began_ns = monotonic_ns();
  const ndt::Fix fix = localizer_.localize(points_m, sweep.end_utc_ns());
  record(Stage::match, began_ns);

  began_ns = monotonic_ns();
  publish(fix);
  record(Stage::publish, began_ns);

  counters_.points_overflowed += sweep.overflowed();
  counters_.points_unfiltered += grid_.dropped_points();
  counters_.pairs_dropped += fix.match.pairs_dropped;
  return {.fix = fix,
          .points_filtered = points_m.size(),
          .complete = sweep.complete(),
          .time_source = sweep.time_source()};
}

void Pipeline::publish(const ndt::Fix& fix) noexcept {
  if (bus_ == nullptr) return;
  // A pose that is not to be used is sent as "not available", never as numbers.
  ndt::Pose pose = fix.at.pose;
  if (!ndt::is_usable(fix.state)) pose.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  const PoseFrames encoded = encoder_.encode(pose);
  for (const CanFrame& frame : encoded.frames) {
    if (!bus_->send(frame, fix.at.stamp_utc_ns)) ++counters_.frames_dropped;
  }
  if (encoded.saturated) ++counters_.frames_saturated;
}

void Pipeline::record(Stage stage, std::int64_t began_ns) noexcept {
  durations_[static_cast<std::size_t>(stage)].record(monotonic_ns() - began_ns);
}

}  // namespace landfix::platform
