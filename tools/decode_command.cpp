// landfix decode: a capture to point clouds, one file a sweep.
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "drivers/make_decoder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pcd_writer.hpp"
#include "tools/capture_census.hpp"
#include "tools/capture_losses.hpp"
#include "tools/command.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/sensor_setup.hpp"

namespace landfix::tools {
namespace {

using drivers::DecodeStatus;
using drivers::SensorModel;
using drivers::Sweep;

enum class Format : std::uint8_t { pcd, csv };

struct Arguments {
  std::string sensor;
  std::string calibration;
  std::string pcap;
  std::string output;
  Format format = Format::pcd;
  drivers::DecoderOptions options;
  bool json = false;
};

struct SweepSummary {
  std::size_t points = 0;
  std::size_t overflowed = 0;
  bool complete = false;
  drivers::TimeSource time_source{};
  double first_time_s = 0.0;  ///< Unix
  double last_time_s = 0.0;
};

struct Summary {
  std::array<std::uint64_t, drivers::kDecodeStatusCount> packets{};  ///< by DecodeStatus
  std::uint64_t elsewhere = 0;                                       ///< packets to other ports
  drivers::StreamCounters stream;
  std::vector<SweepSummary> sweeps;

  [[nodiscard]] std::uint64_t of(DecodeStatus status) const {
    return packets[static_cast<std::size_t>(status)];
  }
  [[nodiscard]] std::uint64_t decoded() const { return of(DecodeStatus::decoded); }
  [[nodiscard]] std::uint64_t rejected() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (drivers::is_rejected(static_cast<DecodeStatus>(i))) sum += packets[i];
    }
    return sum;
  }
};

std::string names_of(std::span<const SensorModel* const> models) {
  std::string names;
  for (const SensorModel* model : models)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", model->name);
  return names;
}

/// The sensor that was asked for, or the only one that the capture can hold.
const SensorModel& choose_sensor(const Arguments& arguments, const CaptureCensus& census) {
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

std::uint16_t port_of(const SensorModel& model, const Arguments& arguments, const CaptureCensus& census) {
  const std::uint16_t port = census.port_of(model);
  if (port != 0) return port;
  const std::string hint =
      census.candidates().empty() ? "" : fmt::format("; it could be {}", names_of(census.candidates()));
  throw std::runtime_error(fmt::format("{}: no packet of {} ({} bytes): it holds {}{}", arguments.pcap,
                                       model.name, fmt::join(model.payload_sizes, ", "), census.to_string(),
                                       hint));
}

void write_csv(const std::filesystem::path& path, std::span<const drivers::Point> points) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "x,y,z,intensity,ring,time\n");
  for (const drivers::Point& point : points) {
    fmt::format_to(std::back_inserter(text), "{:.6f},{:.6f},{:.6f},{:g},{},{:.9f}\n", point.x, point.y,
                   point.z, point.intensity, point.ring, point.time_s);
  }
  platform::AtomicFile file(path);
  file.write(std::string_view(text.data(), text.size()));
  file.commit();
}

class SweepWriter {
 public:
  SweepWriter(std::filesystem::path folder, Format format) : folder_(std::move(folder)), format_(format) {
    std::filesystem::create_directories(folder_);
  }

  void write(const Sweep& sweep, std::vector<SweepSummary>& sweeps) const {
    const std::string name = fmt::format("{:04}.{}", sweeps.size(), format_ == Format::pcd ? "pcd" : "csv");
    if (format_ == Format::pcd) {
      platform::write_pcd(folder_ / name, platform::kPointMembers, sweep.points());
    } else {
      write_csv(folder_ / name, sweep.points());
    }
    sweeps.push_back({.points = sweep.points().size(),
                      .overflowed = sweep.overflowed(),
                      .complete = sweep.complete(),
                      .time_source = sweep.time_source(),
                      .first_time_s = static_cast<double>(sweep.start_utc_ns()) * 1e-9,
                      .last_time_s = static_cast<double>(sweep.end_utc_ns()) * 1e-9});
  }

 private:
  std::filesystem::path folder_;
  Format format_;
};

Summary decode_all(platform::PcapSource& source, std::uint16_t port, std::uint16_t telemetry_port,
                   drivers::AnyDecoder& decoder, drivers::SweepPair& sweeps, const SweepWriter& writer) {
  Summary summary;
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
    if (!result.sweep_completed) continue;
    writer.write(sweeps.completed(), summary.sweeps);
    show_progress(fmt::format("{:3.0f} %, {} sweeps", source.percent_read(), summary.sweeps.size()));
  }
  if (decoder.flush(sweeps)) writer.write(sweeps.completed(), summary.sweeps);
  show_progress("");
  summary.stream = decoder.counters();
  if (status == platform::ReadStatus::truncated) {
    fmt::print(stderr, "the capture ends in the middle of a record ({}): what follows is missing\n",
               source.read_error());
  }
  return summary;
}

void print_json(const SensorModel& model, const Summary& summary) {
  nlohmann::json sweeps = nlohmann::json::array();
  for (const SweepSummary& sweep : summary.sweeps) {
    sweeps.push_back({{"index", sweeps.size()},
                      {"points", sweep.points},
                      {"points_dropped", sweep.overflowed},
                      {"complete", sweep.complete},
                      {"time_source", to_string(sweep.time_source)},
                      {"first_time", sweep.first_time_s},
                      {"last_time", sweep.last_time_s}});
  }
  nlohmann::json reasons = nlohmann::json::object();
  for (std::size_t i = 0; i < summary.packets.size(); ++i) {
    if (summary.packets[i] == 0 || !drivers::is_rejected(static_cast<DecodeStatus>(i))) continue;
    reasons[std::string(drivers::to_string(static_cast<DecodeStatus>(i)))] = summary.packets[i];
  }
  const nlohmann::json object{{"sensor", model.name},
                              {"packets",
                               {{"total", summary.decoded() + summary.rejected()},
                                {"decoded", summary.decoded()},
                                {"rejected", summary.rejected()},
                                {"reasons", reasons},
                                {"telemetry", summary.of(DecodeStatus::telemetry)},
                                {"lost", summary.stream.lost_packets},
                                {"other_ports", summary.elsewhere}}},
                              {"clock_steps", summary.stream.clock_steps},
                              {"restarts", summary.stream.restarts},
                              {"sweeps", sweeps}};
  fmt::print("{}\n", object.dump(2));
}

void print_text(const SensorModel& model, const Summary& summary, const std::string& folder) {
  fmt::print("{}: {} packets decoded, {} rejected, {} lost, {} of telemetry, {} to other ports\n",
             model.display_name, summary.decoded(), summary.rejected(), summary.stream.lost_packets,
             summary.of(DecodeStatus::telemetry), summary.elsewhere);
  for (std::size_t i = 0; i < summary.packets.size(); ++i) {
    if (summary.packets[i] == 0 || !drivers::is_rejected(static_cast<DecodeStatus>(i))) continue;
    fmt::print("  rejected {}: {}\n", summary.packets[i], drivers::to_string(static_cast<DecodeStatus>(i)));
  }
  if (summary.stream.clock_steps != 0) fmt::print("  {} steps of a clock\n", summary.stream.clock_steps);
  if (summary.stream.restarts != 0) fmt::print("  {} restarts of the sensor\n", summary.stream.restarts);
  std::size_t complete = 0;
  for (std::size_t i = 0; i < summary.sweeps.size(); ++i) {
    const SweepSummary& sweep = summary.sweeps[i];
    fmt::print("  {:04}  {:>7} points  {:.6f} to {:.6f}  {} time{}{}\n", i, sweep.points, sweep.first_time_s,
               sweep.last_time_s, to_string(sweep.time_source), sweep.complete ? "" : "  partial",
               sweep.overflowed == 0 ? "" : fmt::format("  {} points did not fit", sweep.overflowed));
    complete += sweep.complete ? 1 : 0;
  }
  fmt::print("{} sweeps, {} complete, in {}\n", summary.sweeps.size(), complete, folder);
}

void decode(const Arguments& arguments) {
  platform::PcapSource source(arguments.pcap);
  const CaptureCensus census(source);
  warn_of_losses(arguments.pcap, source.counters());
  source.rewind();
  const SensorModel& model = choose_sensor(arguments, census);
  const std::uint16_t port = port_of(model, arguments, census);
  const auto calibration = load_calibration(model, arguments.calibration);
  if (arguments.calibration.empty() && model.calibration == drivers::CalibrationUse::optional) {
    fmt::print(stderr, "no --calibration: the angles are the model's, a unit's own differ a little\n");
  }
  drivers::AnyDecoder decoder = drivers::make_decoder(model, arguments.options, calibration);
  std::vector<drivers::Point> storage(2 * model.max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  const SweepWriter writer(arguments.output, arguments.format);
  const Summary summary = decode_all(source, port, model.telemetry_port, decoder, sweeps, writer);
  arguments.json ? print_json(model, summary) : print_text(model, summary, arguments.output);
}

}  // namespace

void add_decode_command(CLI::App& app) {
  const std::map<std::string, Format> formats{{"pcd", Format::pcd}, {"csv", Format::csv}};
  const auto arguments = std::make_shared<Arguments>();
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
      ->transform(CLI::CheckedTransformer(formats).description(""))
      ->type_name("pcd|csv")
      ->default_str("pcd");
  command
      .add_option("--cut-deg", arguments->options.cut_deg,
                  "azimuth at which a sweep begins, clockwise from the front")
      ->check(CLI::Range(-360.0, 360.0).description(""))
      ->type_name("D")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { decode(*arguments); });
}

}  // namespace landfix::tools
