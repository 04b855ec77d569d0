// The vehicle's threads on a simulated drive around a block: what they give is what one thread gives, and on
// the way of a pose nothing allocates, locks or faults a page.
#include "tools/engine_replay.hpp"

#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "platform/candump_log.hpp"
#include "platform/heap_counter.hpp"
#include "platform/map_aid_threads.hpp"
#include "platform/pcap_receiver.hpp"
#include "platform/place_search.hpp"
#include "platform/trajectory.hpp"
#include "support/block_drive.hpp"
#include "tools/engine_setup.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

/// Simulated once for all tests.
class EngineReplay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = std::make_unique<test::BlockDrive>();
    ASSERT_NO_FATAL_FAILURE(drive_->simulate());
    setup_ = std::make_unique<ReplaySetup>(prepare_replay({.config = path("config.toml")}));
  }
  static void TearDownTestSuite() {
    setup_.reset();
    drive_.reset();
  }

  [[nodiscard]] static std::string path(const std::string& name) { return drive_->path(name); }
  [[nodiscard]] static const ReplaySetup& setup() { return *setup_; }

  /// In one.
  [[nodiscard]] static ReplayResult run_plain(const platform::PipelineSettings& settings,
                                              platform::FrameSink* bus) {
    platform::PcapSource source(path("capture.pcap"));
    platform::PlaceSearch search(setup().map());
    search.prepare();
    platform::Pipeline pipeline(settings, setup().decoder, setup().map(), bus, {.search = &search});
    return run_replay(source, pipeline, [&](const platform::SweepResult&) { pipeline.search(); });
  }
  /// In threads.
  [[nodiscard]] static ReplayResult run(platform::EngineMode mode, double speed, std::uint64_t laps,
                                        platform::FrameSink* bus) {
    return run(engine_settings(setup(), mode), speed, laps, bus);
  }
  [[nodiscard]] static ReplayResult run(const platform::EngineSettings& settings, double speed,
                                        std::uint64_t laps, platform::FrameSink* bus) {
    platform::PcapReceiver receiver(pcap_settings(setup(), path("capture.pcap"), speed, laps));
    platform::PlaceSearch search(setup().map());
    search.prepare();
    platform::RunningEngine engine(
        platform::Engine(settings, setup().decoder, setup().map(), {.search = &search}, receiver, bus));
    const bool is_live = settings.mode != platform::EngineMode::fast_replay;
    const platform::MapAidThreads searcher({.search = is_live ? &search : nullptr});
    is_locked_ = engine.missing().empty();
    return run_engine(engine, receiver.counters(), true);
  }
  [[nodiscard]] static bool is_locked() { return is_locked_; }

 private:
  static inline std::unique_ptr<test::BlockDrive> drive_;
  static inline std::unique_ptr<ReplaySetup> setup_;
  static inline bool is_locked_ = false;
};

/// The log and the trajectory of a replay.
struct Written {
  std::string log;
  std::string trajectory;
  bool operator==(const Written&) const = default;
};

template <class Replay>
[[nodiscard]] Written written_by(const std::string& file, Replay replay) {
  platform::CandumpLog bus(file, "can0");
  const ReplayResult result = replay(bus);
  bus.commit();
  return {test::text_of(file), platform::format_tum(result.trajectory())};
}

TEST_F(EngineReplay, GivesWhatOneThreadGives) {
  const Written plain = written_by(
      path("plain.log"), [](platform::FrameSink& bus) { return run_plain(setup().settings, &bus); });
  ASSERT_GT(plain.log.size(), 10'000U);
  EXPECT_EQ(written_by(path("fast.log"),
                       [](platform::FrameSink& bus) {
                         return run(platform::EngineMode::fast_replay, 0.0, 1, &bus);
                       }),
            plain);
  bool is_too_slow = false;
  const Written paced = written_by(path("paced.log"), [&is_too_slow](platform::FrameSink& bus) {
    ReplayResult result = run(platform::EngineMode::paced_replay, 2.0, 1, &bus);
    is_too_slow = result.packets_dropped + result.sweeps_skipped + result.deadline_misses != 0;
    EXPECT_GT(result.duration(platform::Stage::total).count(), 100U);
    return result;
  });
  if (is_too_slow) GTEST_SKIP() << "this computer is too slow, or too busy, for a replay at a pace";
  EXPECT_EQ(paced, plain);
}

TEST_F(EngineReplay, FindsItselfInThreadsAsInOne) {
  platform::EngineSettings settings = engine_settings(setup(), platform::EngineMode::fast_replay);
  settings.pipeline.initial_pose.reset();
  const ReplayResult plain = run_plain(settings.pipeline, nullptr);
  const std::string trajectory = platform::format_tum(plain.trajectory());
  EXPECT_EQ(plain.tally.count(ndt::State::init), ndt::PlaceFinder::kSweepsASearch);
  EXPECT_EQ(platform::format_tum(run(settings, 0.0, 1, nullptr).trajectory()), trajectory);
  settings.mode = platform::EngineMode::paced_replay;
  const ReplayResult paced = run(settings, 1.0, 1, nullptr);
  EXPECT_EQ(paced.heap_calls.value_or(0), 0U);
  if (paced.packets_dropped + paced.sweeps_skipped + paced.deadline_misses + paced.pipeline.answers_late != 0)
    GTEST_SKIP() << "this computer is too slow, or too busy, for a replay at a pace";
  EXPECT_EQ(platform::format_tum(paced.trajectory()), trajectory);
}

TEST_F(EngineReplay, GoesRoundLapAfterLapInFixedMemoryWithoutALock) {
  const ReplayResult once = run(platform::EngineMode::fast_replay, 0.0, 1, nullptr);
  const ReplayResult result = run(platform::EngineMode::fast_replay, 0.0, 4, nullptr);
  EXPECT_GT(result.tally.came(), 4 * once.tally.came() - 8);
  EXPECT_EQ(result.tally.count(ndt::State::lost), 0U);
  EXPECT_LE(result.tally.came() - result.tally.count(ndt::State::tracking), 8U) << "at the seams alone";
  EXPECT_EQ(result.packets_dropped + result.sweeps_skipped + result.deadline_misses + result.results_dropped,
            0U);
  if (!platform::HeapCounter::available()) GTEST_SKIP() << "a sanitizer owns the heap";
  EXPECT_EQ(result.heap_calls, 0U);
  EXPECT_EQ(result.locks, 0U);
  if (!is_locked()) GTEST_SKIP() << "page faults are not counted: no right to lock memory";
  EXPECT_EQ(result.page_faults, 0);
}

/// A bus whose driver does what must not be done.
template <class Deed>
class SinfulBus final : public platform::FrameSink {
 public:
  [[nodiscard]] std::size_t send(std::span<const platform::CanFrame> group, std::int64_t) noexcept override {
    deed();
    return group.size();
  }
  Deed deed;
};

struct Allocates {
  void operator()() const { memory = std::make_unique<int>(1); }
  mutable std::unique_ptr<int> memory;
};
struct Locks {
  void operator()() const { const std::scoped_lock lock(mutex); }
  mutable std::mutex mutex;
};
struct Faults {
  void operator()() const {
    constexpr std::size_t kPage = 4096;
    void* const fresh = ::mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    std::memset(fresh, 1, kPage);
    ::munmap(fresh, kPage);
  }
};

TEST_F(EngineReplay, SeesEachViolation) {
  if (!platform::HeapCounter::available()) GTEST_SKIP() << "a sanitizer owns the heap";
  SinfulBus<Allocates> allocating;
  EXPECT_GT(run(platform::EngineMode::fast_replay, 0.0, 1, &allocating).heap_calls, 100U);
  SinfulBus<Locks> locking;
  EXPECT_GT(run(platform::EngineMode::fast_replay, 0.0, 1, &locking).locks, 100U);
  SinfulBus<Faults> faulting;
  EXPECT_GT(run(platform::EngineMode::fast_replay, 0.0, 1, &faulting).page_faults, 100);
}

TEST_F(EngineReplay, DropsAndSkipsWhatIsTooMuchAndSaysNothingFalse) {
  const ReplayResult result = run(platform::EngineMode::paced_replay, 2000.0, 3, nullptr);
  EXPECT_GT(result.packets_dropped + result.sweeps_skipped, 0U);
  EXPECT_GT(result.tally.came(), 0U);
  const auto truth = platform::read_tum(path("truth.tum"));
  for (const platform::SweepResult& sweep : result.sweeps) {
    const auto there = platform::interpolate(truth, sweep.fix.at.stamp_utc_ns);
    if (!there || sweep.fix.state != ndt::State::tracking) continue;
    EXPECT_LT((sweep.fix.at.pose.translation() - there->translation()).norm(), 0.3);
  }
}

}  // namespace
}  // namespace landfix::tools
