// What the daemon does beside the way of a pose, several times a second: says what changes, tells how things
// are to whoever asks, feeds systemd's watchdog while every thread is alive, keeps the last good pose on
// disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "ndt/localizer.hpp"
#include "platform/engine.hpp"
#include "platform/saved_pose.hpp"
#include "platform/service_notifier.hpp"
#include "tools/engine_snapshot.hpp"
#include "tools/metrics_server.hpp"

namespace landfix::tools {

struct HouseSettings {
  std::filesystem::path resume;    ///< where the last good pose is kept; empty: nowhere
  std::uint32_t map_checksum = 0;  ///< of the map that poses are in
  std::string interface;           ///< of the bus, as messages call it
};

class House {
 public:
  /// `metrics`: who is told how the engine is, or null.
  House(EngineView view, const platform::ServiceNotifier& notifier, MetricsServer* metrics,
        HouseSettings settings)
      : view_(std::move(view)),
        engine_(view_.engine),
        notifier_(notifier),
        metrics_(metrics),
        settings_(std::move(settings)) {}

  /// To be called every 50 ms or so.
  void turn(std::int64_t now_mono_ns);
  /// Once, at the end, when the engine has stopped.
  void close();

 private:
  void take(const platform::SolvedSweep& sweep);
  void watch(std::int64_t now_mono_ns);
  void say_of_bus();
  void save();
  [[nodiscard]] std::string status_line();

  EngineView view_;
  platform::RunningEngine& engine_;
  const platform::ServiceNotifier& notifier_;
  MetricsServer* metrics_;
  HouseSettings settings_;
  ndt::State state_ = ndt::State::init;
  std::optional<ndt::StampedPose> last_good_;  ///< not yet saved
  bool could_save_ = true;
  bool was_late_ = false;
  platform::BusState bus_ = platform::BusState::up;
  std::int64_t alive_due_ns_ = 0;
  std::int64_t status_due_ns_ = 0;
  std::int64_t snapshot_due_ns_ = 0;
  std::int64_t save_due_ns_ = 0;
};

}  // namespace landfix::tools
