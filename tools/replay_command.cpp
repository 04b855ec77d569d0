// landfix replay: a capture through the vehicle's own pipeline.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/candump_log.hpp"
#include "platform/evaluation.hpp"
#include "platform/hgrm.hpp"
#include "platform/pcap_source.hpp"
#include "platform/pipeline.hpp"
#include "platform/trajectory.hpp"
#include "tools/capture_losses.hpp"
#include "tools/command.hpp"
#include "tools/command_line.hpp"
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

struct Arguments {
  ReplayInput input;
  std::string pcap;
  std::string trajectory;
  std::string candump;
  std::string truth;
  std::string svg;
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

void write_svg(const Arguments& arguments, const ndt::VoxelMap& map,
               const std::vector<ndt::StampedPose>& trajectory, const std::vector<ndt::StampedPose>& truth) {
  platform::AtomicFile file(arguments.svg);
  file.write(trajectory_svg(voxel_means(map), trajectory, truth));
  file.commit();
}

void write_html(const Arguments& arguments, const ReplaySetup& setup, const ReplayReport& replay,
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
  platform::AtomicFile file(arguments.report);
  file.write(to_html(report));
  file.commit();
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
    platform::AtomicFile file(stage == whole ? path : platform::hgrm_of_stage(path, to_string(stage)));
    file.write(to_hgrm(platform::distribution_of(durations, to_string(stage))));
    file.commit();
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

void replay(const Arguments& arguments) {
  const ReplaySetup setup = prepare_replay(arguments.input);
  const ndt::VoxelMap map = setup.map();
  const auto truth =
      arguments.truth.empty() ? std::vector<ndt::StampedPose>() : platform::read_tum(arguments.truth);
  std::optional<platform::CandumpLog> bus;
  if (!arguments.candump.empty()) bus.emplace(arguments.candump, setup.configuration.can.interface);
  const std::filesystem::path capture = arguments.pcap.empty()
                                            ? arguments.input.config.parent_path() / "capture.pcap"
                                            : std::filesystem::path(arguments.pcap);
  std::optional<TraceWriter> trace;
  if (!arguments.trace.empty()) trace.emplace(arguments.trace);
  platform::PcapSource source(capture);
  platform::Pipeline pipeline(setup.settings, setup.decoder, map, bus ? &*bus : nullptr, setup.window.get());

  const ReplayResult result = run_replay(source, pipeline, [&](const platform::SweepResult& sweep) {
    if (trace)
      trace->add(platform::SolvedSweep{.result = sweep, .arrived_mono_ns = sweep.times.last_packet_ns});
    if (setup.window) (void)setup.window->load();  // here, so that two replays are the same
    show_progress(fmt::format("{:3.0f} %  {}", source.percent_read(), ndt::to_string(sweep.fix.state)));
  });
  show_progress("");
  warn_of_losses(capture.string(), source.counters());
  if (setup.window) warn_of_window(setup.window->counters());
  if (result.sweeps.empty()) {
    throw std::runtime_error(fmt::format(
        "{}: no sweep of a {} on port {}: {} packets to it, {} rejected, {} from other "
        "senders, {} to other ports; see `landfix decode --pcap`",
        capture.string(), setup.model.name, setup.settings.port, pipeline.counters().packets,
        pipeline.counters().rejected(), pipeline.counters().other_senders, pipeline.counters().other_ports));
  }

  const auto trajectory = result.trajectory();
  if (!arguments.trajectory.empty()) platform::write_tum(arguments.trajectory, trajectory);
  if (bus) bus->commit();
  if (trace) trace->commit();
  if (!arguments.svg.empty()) write_svg(arguments, map, trajectory, truth);
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
  const auto arguments = std::make_shared<Arguments>();
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
  add_file("--truth", arguments->truth, "TRUTH.tum", "true trajectory: report the errors against it");
  add_file("--svg", arguments->svg, "OUT.svg", "draw the trajectory over the map");
  add_file("--report", arguments->report, "OUT.html", "write all of it as one page for a browser");
  add_file("--trace", arguments->trace, "OUT.json", "write what was done when, for ui.perfetto.dev");
  add_file("--latency", arguments->latency, "OUT.hgrm",
           "write the latencies for HdrHistogram's plotters, and of each stage OUT.STAGE.hgrm");
  command.add_flag("--no-deskew{false}", arguments->input.deskew,
                   "leave the sweep's motion distortion in, to see what it costs");
  add_json_option(command, arguments->json);
  command.callback([arguments, &command] {
    arguments->command = command_line(command);
    replay(*arguments);
  });
}

}  // namespace landfix::tools
