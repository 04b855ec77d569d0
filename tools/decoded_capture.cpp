#include "tools/decoded_capture.hpp"

#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "drivers/make_decoder.hpp"
#include "drivers/velodyne/hdl64_status.hpp"
#include "tools/capture_losses.hpp"
#include "tools/command.hpp"
#include "tools/sensor_setup.hpp"

namespace landfix::tools {
namespace {

using drivers::CalibrationUse;
using drivers::DecodeStatus;
using drivers::SensorModel;

std::string names_of(const std::vector<const SensorModel*>& models) {
  std::vector<std::string_view> names;
  names.reserve(models.size());
  for (const SensorModel* const model : models) names.push_back(model->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The sensor that was asked for, or the only one that the capture can hold.
const SensorModel& choose_sensor(const CaptureInput& input, const CaptureCensus& census) {
  if (!input.sensor.empty()) return find_sensor(input.sensor);
  const auto& candidates = census.candidates();
  if (candidates.size() == 1) {
    fmt::print(stderr, "{}: {}, to port {}\n", input.pcap, candidates[0]->display_name,
               census.port_of(*candidates[0]));
    return *candidates[0];
  }
  if (candidates.empty()) {
    throw UsageError(
        fmt::format("{}: no sensor recognised in {}; name it with --sensor (landfix sensors lists them)",
                    input.pcap, census.to_string()));
  }
  throw UsageError(fmt::format("{}: could be {}; choose with --sensor", input.pcap, names_of(candidates)));
}

std::uint16_t port_of(const SensorModel& model, const CaptureInput& input, const CaptureCensus& census) {
  const std::uint16_t port = census.port_of(model);
  if (port != 0) return port;
  const std::string hint =
      census.candidates().empty() ? "" : fmt::format("; it could be {}", names_of(census.candidates()));
  throw std::runtime_error(fmt::format("{}: no packet of {} ({} bytes): it holds {}{}", input.pcap,
                                       model.name, fmt::join(model.payload_sizes, ", "), census.to_string(),
                                       hint));
}

/// A capture may hold the unit's calibration behind the first of its data: it is looked for beforehand. What
/// a RoboSense says is more than its angles, so its decoder takes it.
void learn_from_telemetry(platform::PcapSource& source, const SensorModel& model,
                          drivers::AnyDecoder& decoder, drivers::SweepPair& sweeps) {
  if (model.calibration != CalibrationUse::in_stream || model.telemetry_port == 0) return;
  platform::UdpPacket packet;
  while (source.next(packet) == platform::ReadStatus::packet) {
    if (packet.destination_port != model.telemetry_port) continue;
    static_cast<void>(
        decoder.decode({.payload = packet.payload, .receive_utc_ns = packet.receive_utc_ns}, sweeps));
  }
  source.rewind();
}

/// That an HDL-64E S2 or S3 sends byte by byte with its data: a whole set takes seconds.
drivers::Calibration calibration_in_data(platform::PcapSource& source, const SensorModel& model,
                                         std::uint16_t port) {
  using drivers::velodyne::Hdl64Checksum;
  const bool is_s3 = model.format == drivers::PacketFormat::velodyne_hdl64_s3;
  if (!is_s3 && model.format != drivers::PacketFormat::velodyne_hdl64_s2) return {};
  drivers::velodyne::Hdl64SetCollector collector(is_s3 ? Hdl64Checksum::crc16 : Hdl64Checksum::constant);
  drivers::velodyne::Hdl64Calibration unit;
  bool found = false;
  platform::UdpPacket packet;
  while (!found && source.next(packet) == platform::ReadStatus::packet) {
    if (packet.destination_port != port || !looks_like(model, packet.payload)) continue;
    const auto status = packet.payload.last<2>();
    found = collector.take(std::to_integer<std::uint8_t>(status[0]), std::to_integer<std::uint8_t>(status[1]),
                           unit);
  }
  source.rewind();
  return found ? drivers::Calibration(unit) : drivers::Calibration();
}

/// What to do about a capture that gave no points.
std::string hint_for(const SensorModel& model, const CaptureCensus& census, const DecodeSummary& summary) {
  if (summary.of(DecodeStatus::wrong_model) != 0) {
    auto others = census.candidates();
    std::erase(others, &model);
    return others.empty() ? "" : fmt::format("; it could be {}", names_of(others));
  }
  if (summary.of(DecodeStatus::uncalibrated) == 0) return "";
  return fmt::format("; give the unit's --calibration, or a longer capture with its packets to port {}",
                     model.telemetry_port != 0 ? model.telemetry_port : model.data_port);
}

void refuse_if_nothing_was_decoded(const CaptureInput& input, const SensorModel& model,
                                   const CaptureCensus& census, const DecodeSummary& summary) {
  if (summary.decoded() != 0) return;
  throw std::runtime_error(fmt::format("{}: none of {} packets of {} could be decoded: {}{}", input.pcap,
                                       summary.rejected(), model.name, reasons(summary),
                                       hint_for(model, census, summary)));
}

/// What the file says, or the capture itself.
drivers::Calibration calibration_for(const CaptureInput& input, platform::PcapSource& source,
                                     const SensorModel& model, std::uint16_t port) {
  if (input.calibration.empty() && model.calibration == CalibrationUse::in_stream)
    return calibration_in_data(source, model, port);
  // Of a VLS-128 no maker's file is known, and what it could correct is within 0.03 deg.
  const bool is_vls128 = model.format == drivers::PacketFormat::velodyne_vls128;
  if (input.calibration.empty() && model.calibration == CalibrationUse::optional && !is_vls128)
    fmt::print(stderr, "no --calibration: the angles are the model's, a unit's own differ a little\n");
  return load_calibration(model, input.calibration);
}

}  // namespace

DecodedCapture::DecodedCapture(CaptureInput input)
    : input_(std::move(input)),
      source_(input_.pcap),
      census_(source_),
      model_(choose_sensor(input_, census_)),
      port_(port_of(model_, input_, census_)),
      decoder_([this] {
        warn_of_losses(input_.pcap, source_.counters());
        source_.rewind();
        return drivers::make_decoder(model_, input_.options, calibration_for(input_, source_, model_, port_));
      }()),
      storage_(2 * model_.max_points_per_sweep()),
      sweeps_(storage_) {
  learn_from_telemetry(source_, model_, decoder_, sweeps_);
}

DecodeSummary DecodedCapture::read(const std::function<void(const drivers::Sweep&)>& on_sweep) {
  DecodeSummary summary;
  const auto keep = [&](const drivers::Sweep& sweep) {
    on_sweep(sweep);
    summary.sweeps.push_back({.points = sweep.points().size(),
                              .overflowed = sweep.overflowed(),
                              .lost_packets = sweep.lost_packets(),
                              .complete = sweep.complete(),
                              .time_source = sweep.time_source(),
                              .first_time_s = static_cast<double>(sweep.start_utc_ns()) * 1e-9,
                              .last_time_s = static_cast<double>(sweep.end_utc_ns()) * 1e-9});
  };
  platform::UdpPacket packet;
  auto status = platform::ReadStatus::end;
  while ((status = source_.next(packet)) == platform::ReadStatus::packet) {
    if (packet.destination_port != port_ &&
        (model_.telemetry_port == 0 || packet.destination_port != model_.telemetry_port)) {
      ++summary.elsewhere;
      continue;
    }
    const auto result =
        decoder_.decode({.payload = packet.payload, .receive_utc_ns = packet.receive_utc_ns}, sweeps_);
    ++summary.packets[static_cast<std::size_t>(result.status)];
    if (const auto position = decoder_.position()) summary.position = position;
    if (!result.sweep_completed) continue;
    keep(sweeps_.completed());
  }
  if (decoder_.flush(sweeps_)) keep(sweeps_.completed());
  summary.stream = decoder_.counters();
  summary.position_is_valid = decoder_.position().has_value();
  show_progress("");
  if (status == platform::ReadStatus::truncated) {
    fmt::print(stderr, "the capture ends in the middle of a record ({}): what follows is missing\n",
               source_.read_error());
  }
  refuse_if_nothing_was_decoded(input_, model_, census_, summary);
  return summary;
}

}  // namespace landfix::tools
