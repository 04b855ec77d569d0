// landfix replay: a capture through the vehicle's own pipeline.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/candump_log.hpp"
#include "platform/engine.hpp"
#include "platform/evaluation.hpp"
#include "platform/hgrm.hpp"
#include "platform/map_aid_threads.hpp"
#include "platform/pcap_receiver.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pipeline.hpp"
#include "platform/trajectory.hpp"
#include "tools/capture_losses.hpp"
#include "tools/command.hpp"
#include "tools/command_line.hpp"
#include "tools/engine_replay.hpp"
#include "tools/engine_setup.hpp"
#include "tools/evaluation_report.hpp"
#include "tools/html_report.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/replay_report.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"
#include "tools/trace_writer.hpp"
#include "tools/trajectory_svg.hpp"

namespace landfix::tools {
namespace {

struct ReplayArguments {
  ReplayInput input;
  std::string pcap;
  std::string trajectory;
  std::string candump;
  std::string odometry;
  std::string truth;
  std::string svg;
  bool realtime = false;
  std::uint64_t laps = 1;
  std::string latency;
  std::string report;
  std::string trace;
  std::string command;  ///< as it was given
  bool json = false;
};

[[nodiscard]] std::vector<Eigen::Vector3f> voxel_means(const ndt::VoxelMap& map) {
  std::vector<Eigen::Vector3f> means_m;
  ndt::visit_voxels(map, [&means_m](const ndt::Voxel& /*voxel*/, const Eigen::Vector3d& mean_m) {
    means_m.emplace_back(mean_m.cast<float>());
  });
  return means_m;
}

void write_svg(const ReplayArguments& arguments, const ndt::VoxelMap& map,
               const std::vector<ndt::StampedPose>& trajectory, const std::vector<ndt::StampedPose>& truth) {
  platform::write_file(arguments.svg, trajectory_svg(voxel_means(map), trajectory, truth));
}

void write_html(const ReplayArguments& arguments, const ReplaySetup& setup, const ReplayReport& replay,
                const std::filesystem::path& capture, const std::vector<ndt::StampedPose>& truth) {
  const auto means_m = voxel_means(setup.map());
  const HtmlReport report{
      .replay = replay,
      .truth = truth,
      .map_points_m = means_m,
      .sensor = std::string(setup.model.name),
      .capture = capture.string(),
      .map = (arguments.input.map.empty() ? setup.configuration.map.file : arguments.input.map).string(),
      .command = arguments.command,
      .version = LANDFIX_VERSION};
  platform::write_file(arguments.report, to_html(report));
}

/// What counts in the end by the name that was asked for, the stages that lead there beside it.
void write_latencies(const std::filesystem::path& path, const ReplayResult& result) {
  const platform::Stage whole = result.duration(platform::Stage::total).count() != 0
                                    ? platform::Stage::total
                                    : platform::Stage::last_packet;
  for (std::size_t i = 0; i < platform::kStageCount; ++i) {
    const auto stage = static_cast<platform::Stage>(i);
    const platform::LatencyHistogram& durations = result.duration(stage);
    if (durations.count() == 0 && stage != whole) continue;  // not of this kind of replay
    platform::write_file(stage == whole ? path : platform::hgrm_of_stage(path, to_string(stage)),
                         to_hgrm(platform::distribution_of(durations, to_string(stage))));
  }
}

void warn_of_window(const platform::MapWindowCounters& counters) {
  if (counters.tiles_not_fitting != 0) {
    fmt::print(
        stderr,
        "landfix: in {} windows of the map {} tiles within reach found no room; raise [map] memory_mib\n",
        counters.windows, counters.tiles_not_fitting);
  }
  if (counters.tiles_unreadable != 0) {
    fmt::print(stderr, "landfix: in {} windows of the map {} tiles were damaged or could not be read\n",
               counters.windows, counters.tiles_unreadable);
  }
}

/// What a replay is connected to.
struct Seams {
  platform::FrameSink* bus;
  platform::FrameSource& vehicle_bus;
  TraceWriter* trace;
};

[[nodiscard]] bool uses_threads(const ReplayArguments& arguments) {
  return arguments.realtime || arguments.laps > 1;
}

/// In this thread, packet after packet: as fast as can be, and the same whenever it is done again.
[[nodiscard]] ReplayResult replay_at_once(const ReplaySetup& setup, const std::filesystem::path& capture,
                                          const Seams& seams) {
  platform::PcapSource source(capture);
  if (setup.search) setup.search->prepare();
  platform::Pipeline pipeline(setup.settings, setup.decoder, setup.map(), seams.bus, setup.aids());
  ReplayResult result = run_replay(
      source, pipeline,
      [&](const platform::SweepResult& sweep) {
        if (seams.trace != nullptr)
          seams.trace->add({.result = sweep, .arrived_mono_ns = sweep.times.last_packet_ns});
        // Here, so that two replays are the same.
        if (setup.window) (void)setup.window->load();
        pipeline.search();
        show_progress(fmt::format("{:3.0f} %  {}", source.percent_read(), ndt::to_string(sweep.fix.state)));
      },
      &seams.vehicle_bus);
  warn_of_losses(capture.string(), source.counters());
  return result;
}

/// In the threads of the vehicle. Where the laps are many, their results are counted, not kept.
[[nodiscard]] ReplayResult replay_in_threads(const ReplayArguments& arguments, const ReplaySetup& setup,
                                             const std::filesystem::path& capture, const Seams& seams) {
  const auto mode =
      arguments.realtime ? platform::EngineMode::paced_replay : platform::EngineMode::fast_replay;
  platform::PcapReceiver receiver(
      pcap_settings(setup, capture, arguments.realtime ? 1.0 : 0.0, arguments.laps));
  if (setup.search)
    setup.search->prepare();  // before anything waits for it, so that two replays are the same
  const bool keep_sweeps = arguments.laps == 1 || !arguments.trajectory.empty() || !arguments.truth.empty() ||
                           !arguments.svg.empty() || !arguments.report.empty();
  platform::RunningEngine engine(platform::Engine(engine_settings(setup, mode), setup.decoder, setup.map(),
                                                  setup.aids(), receiver, seams.bus, &seams.vehicle_bus));
  for (const std::string& missing : engine.missing()) fmt::print(stderr, "landfix: {}\n", missing);
  // After the memory was locked: their stacks need not be. As fast as it goes, the solver searches itself.
  const platform::MapAidThreads aid_threads(
      {.window = setup.window.get(), .search = arguments.realtime ? setup.search.get() : nullptr});
  std::size_t sweeps = 0;
  ReplayResult result = run_engine(
      engine, receiver.counters(), keep_sweeps,
      {.on_sweep =
           [&](const platform::SolvedSweep& sweep) {
             if (seams.trace != nullptr) seams.trace->add(sweep);
             show_progress(fmt::format("sweep {}  {}", ++sweeps, ndt::to_string(sweep.result.fix.state)));
           },
       .on_sent =
           [&](const platform::SentSweep& sent) {
             if (seams.trace != nullptr) seams.trace->add(sent);
           }});
  warn_of_losses(capture.string(), receiver.source().counters());
  return result;
}

[[nodiscard]] std::vector<platform::StampedFrame> read_vehicle_bus(const ReplayArguments& arguments,
                                                                   const ReplaySetup& setup) {
  if (arguments.odometry.empty()) {
    const platform::PipelineSettings& known = setup.settings;
    if (setup.search || known.initial_pose || known.initial_area) return {};
    throw UsageError(
        "where is the vehicle? No bus on which GNSS could tell it: give --initial-pose, [initial_pose] in "
        "the "
        "configuration, or --odometry with a log");
  }
  if (setup.settings.odometry.count + setup.settings.gnss.count == 0) {
    throw UsageError(
        fmt::format("--odometry: [[odometry.signal]] or [[gnss.signal]] in {} must say what the frames mean",
                    arguments.input.config.string()));
  }
  return platform::read_candump(arguments.odometry);
}

void replay(const ReplayArguments& arguments) {
  const ReplaySetup setup = prepare_replay(arguments.input);
  const auto truth =
      arguments.truth.empty() ? std::vector<ndt::StampedPose>() : platform::read_tum(arguments.truth);
  std::optional<platform::CandumpLog> bus;
  if (!arguments.candump.empty()) bus.emplace(arguments.candump, setup.configuration.can.interface);
  const std::filesystem::path capture = arguments.pcap.empty()
                                            ? arguments.input.config.parent_path() / "capture.pcap"
                                            : std::filesystem::path(arguments.pcap);
  platform::FrameSink* const sink = bus ? &*bus : nullptr;
  const std::vector<platform::StampedFrame> logged = read_vehicle_bus(arguments, setup);
  platform::FrameLog vehicle_bus(logged);
  std::optional<TraceWriter> trace;
  if (!arguments.trace.empty()) trace.emplace(arguments.trace);
  const Seams seams{.bus = sink, .vehicle_bus = vehicle_bus, .trace = trace ? &*trace : nullptr};
  const ReplayResult result = uses_threads(arguments) ? replay_in_threads(arguments, setup, capture, seams)
                                                      : replay_at_once(setup, capture, seams);
  show_progress("");
  if (setup.window) warn_of_window(setup.window->counters());
  if (result.tally.came() == 0) {
    throw std::runtime_error(
        fmt::format("{}: no sweep of a {} on port {}: {} packets to it, {} rejected, {} from other "
                    "senders, {} to other ports; see `landfix decode --pcap`",
                    capture.string(), setup.model.name, setup.settings.port, result.pipeline.packets,
                    result.pipeline.rejected(), result.pipeline.other_senders, result.pipeline.other_ports));
  }

  const auto trajectory = result.trajectory();
  if (!arguments.trajectory.empty()) platform::write_tum(arguments.trajectory, trajectory);
  if (bus) bus->commit();
  if (trace) trace->commit();
  if (!arguments.svg.empty()) write_svg(arguments, setup.map(), trajectory, truth);
  if (!arguments.latency.empty()) write_latencies(arguments.latency, result);
  ReplayReport report{.result = result, .evaluation = {}, .covariances = {}};
  if (!arguments.truth.empty() && !trajectory.empty()) {
    report.evaluation = platform::evaluate(truth, trajectory);
    report.covariances = check_covariances(result.sweeps, truth);
  }
  if (!arguments.report.empty()) write_html(arguments, setup, report, capture, truth);
  fmt::print("{}", arguments.json ? to_json(report).dump(2) + "\n" : to_text(report));
}

}  // namespace

void add_replay_command(CLI::App& app) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App& command =
      *app.add_subcommand("replay", "a capture through the vehicle's pipeline: packets in, poses out");
  const auto add_file = [&command](const char* name, auto& path, const char* type, const char* what) {
    return command.add_option(name, path, what)->type_name(type);
  };
  add_file("--config", arguments->input.config, "FILE",
           "configuration (config/landfix.toml explains every key)")
      ->required();
  add_file("--pcap", arguments->pcap, "FILE",
           "capture, pcap or pcapng; else capture.pcap beside the configuration");
  add_file("--map", arguments->input.map, "MAP.ndt", "map, in place of the configuration's");
  add_pose_option(command, "--initial-pose", arguments->input.initial_pose,
                  "pose at the first sweep, map <- vehicle [m, deg], in place of the configuration's");
  add_file("--trajectory", arguments->trajectory, "OUT.tum", "write the poses");
  add_file("--candump", arguments->candump, "OUT.log", "write the CAN frames, as candump -l does");
  add_file(
      "--odometry", arguments->odometry, "CAN.log",
      "frames of the vehicle's bus, as candump -l writes them: what [odometry] and [gnss] tell how to read");
  add_file("--truth", arguments->truth, "TRUTH.tum", "true trajectory: report the errors against it");
  add_file("--svg", arguments->svg, "OUT.svg", "draw the trajectory over the map");
  add_file("--report", arguments->report, "OUT.html", "write all of it as one page for a browser");
  add_file("--trace", arguments->trace, "OUT.json", "write what was done when, for ui.perfetto.dev");
  add_file("--latency", arguments->latency, "OUT.hgrm",
           "write the latencies for HdrHistogram's plotters, and of each stage OUT.STAGE.hgrm");
  command.add_flag("--no-deskew{false}", arguments->input.deskew,
                   "leave the sweep's motion distortion in, to see what it costs");
  command.add_flag("--realtime", arguments->realtime,
                   "at the capture's own pace, in the vehicle's threads: shows latency and what is dropped");
  command
      .add_option(
          "--loop", arguments->laps,
          "run through the capture N times, in the vehicle's threads, its times shifted a lap each; for "
          "routes that end where they begin")
      ->type_name("N")
      ->check(in_range(1, 1'000'000));
  add_json_option(command, arguments->json);
  command.callback([arguments, &command] {
    arguments->command = command_line(command);
    replay(*arguments);
  });
}

}  // namespace landfix::tools
