#include "platform/engine.hpp"

#include <stdexcept>
#include <utility>

#include "platform/monotonic_clock.hpp"
#include "platform/realtime.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/receive_loop.hpp"
#include "platform/send_loop.hpp"
#include "platform/solve_loop.hpp"

namespace landfix::platform {

struct EngineParts {
  EngineParts(EngineSettings engine_settings, const drivers::AnyDecoder& decoder, const ndt::VoxelMap& map,
              const MapAids& aids, PacketReceiver& receiver, FrameSink* bus, FrameSource* vehicle_bus)
      : settings(std::move(engine_settings)),
        links(settings.mode, settings.slot_bytes, settings.slots),
        pipeline(settings.pipeline, decoder, map, nullptr, aids),
        receive(links, receiver),
        solve(links, pipeline, vehicle_bus, settings.deadline_ns),
        send(links, settings.pipeline.publish, settings.rate_hz, bus) {}
  /// Threads that have begun, where the next could not, end too.
  ~EngineParts() { tell_to_stop(); }
  EngineParts(const EngineParts&) = delete;
  EngineParts& operator=(const EngineParts&) = delete;

  void tell_to_stop() noexcept {
    links.stop.store(true, std::memory_order_relaxed);
    links.packets_bell.ring();
    links.fixes_bell.ring();
  }

  EngineSettings settings;
  EngineLinks links;
  Pipeline pipeline;
  ReceiveLoop receive;
  SolveLoop solve;
  SendLoop send;
  std::vector<std::string> missing;
  std::atomic<int> running{0};  ///< threads that have not ended: release by each at its end
  // Last, so that they end before what they use.
  std::vector<std::unique_ptr<RealtimeThread>> threads;
};

namespace {

template <class Loop>
void begin_thread(EngineParts& parts, const char* name, ThreadSchedule schedule, bool flushes_denormals,
                  Loop& loop) {
  if (parts.settings.realtime.mode == RealtimeMode::off) schedule = {};
  const RealtimeThreadSettings settings{
      .name = name, .schedule = schedule, .flushes_denormals = flushes_denormals};
  parts.running.fetch_add(1, std::memory_order_relaxed);
  parts.threads.push_back(std::make_unique<RealtimeThread>(settings, [&parts, &loop]() noexcept {
    loop.run();
    parts.running.fetch_sub(1, std::memory_order_release);
  }));
  for (const std::string& sentence : parts.threads.back()->missing()) parts.missing.push_back(sentence);
}

}  // namespace

Engine::Engine(const EngineSettings& settings, const drivers::AnyDecoder& decoder, const ndt::VoxelMap& map,
               const MapAids& aids, PacketReceiver& receiver, FrameSink* bus, FrameSource* vehicle_bus)
    : parts_(std::make_unique<EngineParts>(settings, decoder, map, aids, receiver, bus, vehicle_bus)) {
  parts_->pipeline.warm_up();
}

Engine::~Engine() = default;

RunningEngine::RunningEngine(Engine&& ready) : parts_(std::move(ready.parts_)) {
  EngineParts& parts = *parts_;
  const RealtimeSettings& realtime = parts.settings.realtime;
  parts.threads.reserve(3);
  if (realtime.mode != RealtimeMode::off && realtime.lock_memory) {
    if (const Missing missing = lock_memory()) parts.missing.push_back(*missing);
  }
  // The last on the way of a packet first, so that nothing waits for a thread that is not there.
  begin_thread(parts, "tx", realtime.tx, false, parts.send);
  begin_thread(parts, "solve", realtime.solve, true, parts.solve);
  begin_thread(parts, "rx", realtime.rx, false, parts.receive);
  if (realtime.mode == RealtimeMode::required && !parts.missing.empty()) {
    stop();
    throw std::runtime_error("[realtime] mode = \"required\", but " + parts.missing.front());
  }
}

RunningEngine::~RunningEngine() { stop(); }

const std::vector<std::string>& RunningEngine::missing() const noexcept { return parts_->missing; }

std::optional<SolvedSweep> RunningEngine::next_sweep() noexcept {
  SolvedSweep sweep;
  return parts_->links.sweeps.pop(sweep) ? std::optional(sweep) : std::nullopt;
}

std::optional<SentSweep> RunningEngine::next_sent() noexcept {
  SentSweep sent;
  return parts_->links.sent.pop(sent) ? std::optional(sent) : std::nullopt;
}

bool RunningEngine::has_ended() const noexcept {
  return parts_->running.load(std::memory_order_acquire) == 0;
}

ReceiveStatus RunningEngine::ending() const noexcept { return parts_->receive.ending(); }

void RunningEngine::stop() noexcept {
  parts_->tell_to_stop();
  parts_->threads.clear();
}

const SolveStatus& RunningEngine::solve_status() noexcept {
  (void)parts_->links.status.update();
  return parts_->links.status.front();
}

const PublishCounters& RunningEngine::publish_counters() const noexcept { return parts_->send.counters(); }

const LatencyHistogram& RunningEngine::durations(Stage stage) const noexcept {
  switch (stage) {
    case Stage::kernel_receive:
      return parts_->solve.kernel_receive();
    case Stage::ring_wait:
      return parts_->solve.ring_wait();
    case Stage::publish:
      return parts_->send.publish_time();
    case Stage::total:
      return parts_->send.total();
    default:
      return parts_->pipeline.durations(stage);
  }
}

std::array<EngineThread, 3> RunningEngine::threads() const noexcept {
  return {
      {{"rx", &parts_->receive.watch()}, {"solve", &parts_->solve.watch()}, {"tx", &parts_->send.watch()}}};
}

}  // namespace landfix::platform
