#include "tools/daemon.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <exception>
#include <optional>

#include <fmt/format.h>

#include "platform/can_receiver.hpp"
#include "platform/engine.hpp"
#include "platform/map_aid_threads.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/realtime.hpp"
#include "platform/saved_pose.hpp"
#include "platform/service_notifier.hpp"
#include "platform/socket_can.hpp"
#include "platform/udp_receiver.hpp"
#include "platform/udp_settings.hpp"
#include "tools/engine_setup.hpp"
#include "tools/house.hpp"
#include "tools/journal.hpp"
#include "tools/metrics_server.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

/// The signals that the daemon heeds, kept for it to ask for: no thread is ever interrupted.
class Signals {
 public:
  /// To be made before any thread is.
  Signals() noexcept {
    sigemptyset(&set_);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set_, signal);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }
  /// The next one, waited for at most so long; 0: none.
  [[nodiscard]] int wait(std::int64_t longest_ns) const noexcept {
    const timespec longest{.tv_sec = 0, .tv_nsec = longest_ns};
    const int signal = sigtimedwait(&set_, nullptr, &longest);
    return signal > 0 ? signal : 0;
  }

 private:
  sigset_t set_{};
};

/// The last good pose of the run before, if it is of this map.
[[nodiscard]] std::optional<ndt::Pose> pose_to_resume(const platform::Configuration& configuration,
                                                      std::uint32_t map_checksum) {
  const std::filesystem::path& path = configuration.initial_pose.resume;
  if (path.empty() || !std::filesystem::exists(path)) return std::nullopt;
  try {
    const platform::SavedPose saved = platform::read_saved_pose(path);
    if (saved.map_checksum != map_checksum) {
      log_line(Severity::notice, fmt::format("{}: is of another map; not resumed", path.string()));
      return std::nullopt;
    }
    const Eigen::Vector3d& place_m = saved.at.pose.translation();
    log_line(Severity::info, fmt::format("resuming at {:.2f} {:.2f} {:.2f}, as kept in {}", place_m.x(),
                                         place_m.y(), place_m.z(), path.string()));
    return saved.at.pose;
  } catch (const std::exception& error) {
    log_line(Severity::warning, fmt::format("not resumed: {}", error.what()));
    return std::nullopt;
  }
}

/// What is listened to on the vehicle's bus.
[[nodiscard]] std::vector<platform::CanId> ids_of(const platform::Configuration& configuration) {
  std::vector<platform::CanId> ids;
  const auto add = [&ids](const platform::VehicleSignals& signals) {
    for (const platform::VehicleSignal& signal : signals.all()) {
      const bool is_known = std::any_of(ids.begin(), ids.end(), [&signal](const platform::CanId& id) {
        return id.id == signal.id && id.extended == signal.extended;
      });
      if (!is_known) ids.push_back({signal.id, signal.extended});
    }
  };
  add(configuration.odometry);
  add(configuration.gnss);
  return ids;
}

void keep_house(House& house, const Signals& signals) {
  constexpr std::int64_t kTurn_ns = 50'000'000;
  for (;;) {
    const int signal = signals.wait(kTurn_ns);
    if (signal == SIGTERM || signal == SIGINT) return;
    if (signal == SIGHUP) {
      log_line(Severity::warning, "SIGHUP: the configuration is read at the start only; restart instead");
    }
    house.turn(platform::monotonic_ns());
  }
}

}  // namespace

void run_daemon(const std::filesystem::path& config) {
  const Signals signals;
  const platform::ServiceNotifier notifier;
  const ReplaySetup setup = prepare_replay({.config = config, .last_pose = pose_to_resume});
  platform::keep_heap_pages();  // from here on: what the set-up needed for a while may go
  platform::UdpReceiver receiver(platform::udp_settings(setup.configuration.sensor, setup.model));
  for (const std::string& warning : receiver.warnings()) log_line(Severity::warning, warning);
  platform::SocketCan bus(setup.configuration.can.interface, setup.configuration.can.fd);
  std::optional<MetricsServer> metrics;  // before the memory is locked: its stack is to be kept
  if (!setup.configuration.metrics.address.empty()) metrics.emplace(setup.configuration.metrics.address);
  const std::vector<platform::CanId> vehicle_ids = ids_of(setup.configuration);
  std::optional<platform::CanReceiver> vehicle_bus;
  if (!vehicle_ids.empty()) vehicle_bus.emplace(setup.configuration.can.interface, vehicle_ids);
  platform::RunningEngine engine(platform::Engine(engine_settings(setup, platform::EngineMode::live),
                                                  setup.decoder, setup.map(), setup.aids(), receiver, &bus,
                                                  vehicle_bus ? &*vehicle_bus : nullptr));
  for (const std::string& missing : engine.missing()) log_line(Severity::warning, missing);
  // After the memory was locked: their stacks need not be.
  const platform::MapAidThreads aid_threads(setup.aids());
  if (!setup.search) {
    log_line(Severity::notice,
             fmt::format("a lost vehicle is looked for near its last place alone, as {}", setup.no_search));
  }

  constexpr std::int64_t kThreadBudget_ns = 1'000'000'000;  // each comes round at least every 100 ms
  House house({.engine = engine,
               .received = receiver.counters(),
               .bus = bus,
               .sensor = std::string(setup.model.name),
               .began_mono_ns = platform::monotonic_ns(),
               .thread_budget_ns = kThreadBudget_ns},
              notifier, metrics ? &*metrics : nullptr,
              {.resume = setup.configuration.initial_pose.resume,
               .map_checksum = setup.map_checksum(),
               .interface = setup.configuration.can.interface});
  notifier.ready("ready");
  log_line(Severity::info, fmt::format("{} on port {}, poses on {}", setup.model.display_name,
                                       setup.settings.port, setup.configuration.can.interface));
  keep_house(house, signals);
  notifier.stopping("stopping");
  engine.stop();
  house.close();
}

}  // namespace landfix::tools
