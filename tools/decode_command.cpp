// landfix decode: a capture to point clouds, one file a sweep.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "drivers/make_decoder.hpp"
#include "drivers/velodyne/hdl64_status.hpp"
#include "platform/pcap_source.hpp"
#include "tools/capture_census.hpp"
#include "tools/capture_losses.hpp"
#include "tools/command.hpp"
#include "tools/decode_report.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/sensor_setup.hpp"
#include "tools/sweep_files.hpp"

namespace landfix::tools {
namespace {

using drivers::CalibrationUse;
using drivers::DecodeStatus;
using drivers::SensorModel;
using drivers::Sweep;

struct DecodeArguments {
  std::string sensor;
  std::string calibration;
  std::string pcap;
  std::string output;
  SweepFormat format = SweepFormat::pcd;
  drivers::DecoderOptions options;
  bool json = false;
};

std::string names_of(const std::vector<const SensorModel*>& models) {
  std::vector<std::string_view> names;
  names.reserve(models.size());
  for (const SensorModel* const model : models) names.push_back(model->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The sensor that was asked for, or the only one that the capture can hold.
const SensorModel& choose_sensor(const DecodeArguments& arguments, const CaptureCensus& census) {
  if (!arguments.sensor.empty()) return find_sensor(arguments.sensor);
  const auto& candidates = census.candidates();
  if (candidates.size() == 1) {
    fmt::print(stderr, "{}: {}, to port {}\n", arguments.pcap, candidates[0]->display_name,
               census.port_of(*candidates[0]));
    return *candidates[0];
  }
  if (candidates.empty()) {
    throw UsageError(
        fmt::format("{}: no sensor recognised in {}; name it with --sensor (landfix sensors lists them)",
                    arguments.pcap, census.to_string()));
  }
  throw UsageError(
      fmt::format("{}: could be {}; choose with --sensor", arguments.pcap, names_of(candidates)));
}

std::uint16_t port_of(const SensorModel& model, const DecodeArguments& arguments,
                      const CaptureCensus& census) {
  const std::uint16_t port = census.port_of(model);
  if (port != 0) return port;
  const std::string hint =
      census.candidates().empty() ? "" : fmt::format("; it could be {}", names_of(census.candidates()));
  throw std::runtime_error(fmt::format("{}: no packet of {} ({} bytes): it holds {}{}", arguments.pcap,
                                       model.name, fmt::join(model.payload_sizes, ", "), census.to_string(),
                                       hint));
}

DecodeSummary decode_all(platform::PcapSource& source, std::uint16_t port, std::uint16_t telemetry_port,
                         drivers::AnyDecoder& decoder, drivers::SweepPair& sweeps, SweepFiles& files) {
  DecodeSummary summary;
  const auto keep = [&](const Sweep& sweep) {
    files.write(sweep);
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
  while ((status = source.next(packet)) == platform::ReadStatus::packet) {
    if (packet.destination_port != port &&
        (telemetry_port == 0 || packet.destination_port != telemetry_port)) {
      ++summary.elsewhere;
      continue;
    }
    const auto result =
        decoder.decode({.payload = packet.payload, .receive_utc_ns = packet.receive_utc_ns}, sweeps);
    ++summary.packets[static_cast<std::size_t>(result.status)];
    if (const auto position = decoder.position()) summary.position = position;
    if (!result.sweep_completed) continue;
    keep(sweeps.completed());
    show_progress(fmt::format("{:3.0f} %, {} sweeps", source.percent_read(), summary.sweeps.size()));
  }
  if (decoder.flush(sweeps)) keep(sweeps.completed());
  show_progress("");
  summary.stream = decoder.counters();
  summary.position_is_valid = decoder.position().has_value();
  if (status == platform::ReadStatus::truncated) {
    fmt::print(stderr, "the capture ends in the middle of a record ({}): what follows is missing\n",
               source.read_error());
  }
  return summary;
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

void refuse_if_nothing_was_decoded(const DecodeArguments& arguments, const SensorModel& model,
                                   const CaptureCensus& census, const DecodeSummary& summary) {
  if (summary.decoded() != 0) return;
  throw std::runtime_error(fmt::format("{}: none of {} packets of {} could be decoded: {}{}", arguments.pcap,
                                       summary.rejected(), model.name, reasons(summary),
                                       hint_for(model, census, summary)));
}

void decode(const DecodeArguments& arguments) {
  platform::PcapSource source(arguments.pcap);
  const CaptureCensus census(source);
  warn_of_losses(arguments.pcap, source.counters());
  source.rewind();
  const SensorModel& model = choose_sensor(arguments, census);
  const std::uint16_t port = port_of(model, arguments, census);
  const auto calibration = arguments.calibration.empty() && model.calibration == CalibrationUse::in_stream
                               ? calibration_in_data(source, model, port)
                               : load_calibration(model, arguments.calibration);
  // Of a VLS-128 no maker's file is known, and what it could correct is within 0.03 deg.
  const bool is_vls128 = model.format == drivers::PacketFormat::velodyne_vls128;
  if (arguments.calibration.empty() && model.calibration == CalibrationUse::optional && !is_vls128) {
    fmt::print(stderr, "no --calibration: the angles are the model's, a unit's own differ a little\n");
  }
  drivers::AnyDecoder decoder = drivers::make_decoder(model, arguments.options, calibration);
  std::vector<drivers::Point> storage(2 * model.max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  learn_from_telemetry(source, model, decoder, sweeps);
  SweepFiles files(arguments.output, arguments.format);
  const DecodeSummary summary = decode_all(source, port, model.telemetry_port, decoder, sweeps, files);
  refuse_if_nothing_was_decoded(arguments, model, census, summary);
  if (const std::size_t older = files.left_over(); older != 0) {
    fmt::print(stderr, "{} also holds {} sweeps of an earlier run, behind the last of this one\n",
               arguments.output, older);
  }
  arguments.json ? print_json(model, summary) : print_text(model, summary, arguments.output);
}

}  // namespace

void add_decode_command(CLI::App& app) {
  const std::map<std::string, SweepFormat> formats{{"pcd", SweepFormat::pcd}, {"csv", SweepFormat::csv}};
  const auto arguments = std::make_shared<DecodeArguments>();
  CLI::App& command = *app.add_subcommand("decode", "point clouds from a capture, one file a sweep");
  command.add_option("--sensor", arguments->sensor, "its name (landfix sensors); found out where not given")
      ->type_name("NAME");
  command.add_option("--calibration", arguments->calibration, "the unit's own file (see landfix sensors)")
      ->type_name("FILE");
  command.add_option("--pcap", arguments->pcap, "capture, pcap or pcapng")->required()->type_name("FILE");
  command.add_option("--output", arguments->output, "folder for 0000.pcd and on")
      ->required()
      ->type_name("DIR");
  command.add_option("--format", arguments->format, "of the files")
      ->transform(one_of(formats))
      ->type_name("pcd|csv")
      ->default_str("pcd");
  command
      .add_option(
          "--cut-deg", arguments->options.cut_deg,
          "azimuth at which a sweep begins, clockwise from the front; Ouster's begin where its frames do")
      ->check(CLI::Range(-360.0, 360.0).description(""))
      ->type_name("D")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { decode(*arguments); });
}

}  // namespace landfix::tools
