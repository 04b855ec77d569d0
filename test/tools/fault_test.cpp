// What goes wrong around a vehicle, each as a drive: nothing crashes, what is published as TRACKING is true,
// and after the fault the vehicle is found again without help.
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "ndt/map_layout.hpp"
#include "ndt/pose.hpp"
#include "platform/can_frame.hpp"
#include "platform/candump_log.hpp"
#include "platform/nanoseconds.hpp"
#include "platform/place_search.hpp"
#include "platform/saved_pose.hpp"
#include "platform/trajectory.hpp"
#include "support/block_drive.hpp"
#include "support/child_process.hpp"
#include "support/drive_verdict.hpp"
#include "support/error_of.hpp"
#include "support/packet_list.hpp"
#include "support/pandar_packets.hpp"
#include "support/synthetic_packets.hpp"
#include "tools/replay_run.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {
namespace {

using test::OwnedPacket;
using test::PacketList;

constexpr std::size_t kPayload = 1206;
/// When the faults begin and end, from the start of the drive [s].
constexpr double kFrom_s = 5.03;
constexpr double kUntil_s = 15.03;
constexpr double kWorst_m = 0.3;
constexpr double kWorst_deg = 1.0;

/// Of a drive with a fault.
struct Fault {
  const char* name;
  std::function<PacketList(const PacketList&)> spoil;
  double until_s = kUntil_s;
  double recovery_limit_s = 0.3;  ///< of sensor time, from the end of the fault until TRACKING
  std::int64_t leap_ns = 0;       ///< of the stamps from the fault on
};

class Faults : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = std::make_unique<test::BlockDrive>();
    ASSERT_NO_FATAL_FAILURE(drive_->simulate());
    setup_ = std::make_unique<ReplaySetup>(prepare_replay({.config = path("config.toml")}));
    packets_ = test::read_packets(path("capture.pcap"));
    truth_ = platform::read_tum(path("truth.tum"));
  }
  static void TearDownTestSuite() {
    packets_.clear();
    setup_.reset();
    drive_.reset();
  }

  [[nodiscard]] static std::string path(const std::string& name) { return drive_->path(name); }
  [[nodiscard]] static const ReplaySetup& setup() { return *setup_; }
  [[nodiscard]] static const PacketList& packets() { return packets_; }

  /// Of a packet, from the start of the drive.
  [[nodiscard]] static double seconds_of(const OwnedPacket& packet) {
    return to_seconds(packet.packet.receive_utc_ns - packets_.front().packet.receive_utc_ns);
  }

  [[nodiscard]] static ReplayResult replay(const PacketList& packets, platform::FrameSink* bus = nullptr,
                                           std::uint32_t sensor_address = 0) {
    platform::PlaceSearch search(setup().map());
    search.prepare();
    return replay(packets, bus, sensor_address, &search);
  }
  /// `search`: none where the map is larger than memory.
  [[nodiscard]] static ReplayResult replay(const PacketList& packets, platform::FrameSink* bus,
                                           std::uint32_t sensor_address, platform::PlaceSearch* search) {
    test::ListSource source(packets);
    platform::PipelineSettings settings = setup().settings;
    settings.sensor_address = sensor_address;
    platform::Pipeline pipeline(settings, setup().decoder, setup().map(), bus, {.search = search});
    return run_replay(source, pipeline, [&](const platform::SweepResult&) { pipeline.search(); });
  }

  static void expect_survival(const Fault& fault, const ReplayResult& result) {
    const std::int64_t start_utc_ns = packets_.front().packet.receive_utc_ns;
    const auto until_utc_ns = start_utc_ns + static_cast<std::int64_t>(fault.until_s * 1e9);
    const test::DriveVerdict verdict = test::judge_drive(result.sweeps, truth_, until_utc_ns, fault.leap_ns);
    const auto count = [&](ndt::State state) { return result.tally.count(state); };
    const std::string recovery = verdict.recovery_s ? fmt::format("{:.2f} s, {} sweeps", *verdict.recovery_s,
                                                                  verdict.sweeps_to_tracking)
                                                    : "never";
    const std::string row = fmt::format(
        "{}: worst {:.2f} m {:.2f} deg; TRACKING {} DEGRADED {} PREDICTED {} LOST {} NO_DATA {}; again after "
        "{}",
        fault.name, verdict.worst_m, verdict.worst_deg, count(ndt::State::tracking),
        count(ndt::State::degraded), count(ndt::State::predicted), count(ndt::State::lost),
        count(ndt::State::no_data), recovery);
    fmt::print("{}\n", row);
    RecordProperty(std::string("fault ") + fault.name, row);
    EXPECT_LT(verdict.worst_m, kWorst_m) << fault.name;
    EXPECT_LT(verdict.worst_deg, kWorst_deg) << fault.name;
    EXPECT_TRUE(verdict.ends_tracking) << fault.name;
    EXPECT_GT(count(ndt::State::tracking), 0U) << fault.name;
    ASSERT_TRUE(verdict.recovery_s) << fault.name;
    EXPECT_LE(*verdict.recovery_s, fault.recovery_limit_s) << fault.name;
    EXPECT_TRUE(!result.heap_calls || *result.heap_calls == 0U) << fault.name;
  }
  static void expect_survival(const Fault& fault) { expect_survival(fault, replay(fault.spoil(packets_))); }

  [[nodiscard]] static double to_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

 private:
  static inline std::unique_ptr<test::BlockDrive> drive_;
  static inline std::unique_ptr<ReplaySetup> setup_;
  static inline PacketList packets_;
  static inline std::vector<ndt::StampedPose> truth_;
};

/// `packets` less those in the time of the fault that `drop` chooses.
template <class Drop>
[[nodiscard]] PacketList without(const PacketList& packets, double until_s, Drop drop) {
  const std::int64_t start_ns = packets.front().packet.receive_utc_ns;
  PacketList rest;
  for (const OwnedPacket& packet : packets) {
    const double time_s = static_cast<double>(packet.packet.receive_utc_ns - start_ns) * 1e-9;
    if (time_s < kFrom_s || time_s >= until_s || !drop(time_s)) rest.push_back(packet);
  }
  return rest;
}

[[nodiscard]] auto lose(double share) {
  return [share](const PacketList& packets) {
    std::mt19937_64 random(1);
    const auto limit = static_cast<std::uint64_t>(share * 1000.0);
    return without(packets, kUntil_s, [&](double) { return random() % 1000 < limit; });
  };
}

/// Every second, for that long, nothing.
[[nodiscard]] auto bursts(double length_s) {
  return [length_s](const PacketList& packets) {
    return without(packets, kUntil_s, [&](double time_s) { return time_s - std::floor(time_s) < length_s; });
  };
}

[[nodiscard]] auto silence(double length_s) {
  return [length_s](const PacketList& packets) {
    return without(packets, kFrom_s + length_s, [](double) { return true; });
  };
}

/// Of several that differ in degree. Under sanitizers, where each takes ten times as long, the first and the
/// last stand for all.
template <class Variant, std::size_t N>
[[nodiscard]] std::vector<Variant> variants(const std::array<Variant, N>& all) {
  if (LANDFIX_SANITIZED) return {all.front(), all.back()};
  return {all.begin(), all.end()};
}

TEST_F(Faults, LostPackets) {
  expect_survival({.name = "nothing", .spoil = [](const PacketList& packets) { return packets; }});
  const std::array<std::pair<const char*, double>, 4> losses{{{"1 % of packets lost", 0.01},
                                                              {"10 % of packets lost", 0.1},
                                                              {"50 % of packets lost", 0.5},
                                                              {"90 % of packets lost", 0.9}}};
  for (const auto& [name, share] : variants(losses)) {
    expect_survival({.name = name, .spoil = lose(share), .recovery_limit_s = 1.0});
  }
}

TEST_F(Faults, Bursts) {
  expect_survival({.name = "bursts of 50 ms", .spoil = bursts(0.05)});
  expect_survival({.name = "bursts of 250 ms", .spoil = bursts(0.25)});
  expect_survival({.name = "bursts of 800 ms", .spoil = bursts(0.8), .recovery_limit_s = 2.0});
}

TEST_F(Faults, Silence) {
  const std::array<std::pair<const char*, double>, 8> silences{{{"0.5 s of silence", 0.5},
                                                                {"1.5 s of silence", 1.5},
                                                                {"3 s of silence", 3.0},
                                                                {"5 s of silence", 5.0},
                                                                {"7 s of silence", 7.0},
                                                                {"10 s of silence", 10.0},
                                                                // Where half of a sweep fits another place.
                                                                {"10.6 s of silence", 10.6},
                                                                {"10.8 s of silence", 10.8}}};
  for (const auto& [name, length_s] : variants(silences)) {
    expect_survival(
        {.name = name, .spoil = silence(length_s), .until_s = kFrom_s + length_s, .recovery_limit_s = 1.5});
    const std::string alone = fmt::format("{}, no search over the map", name);
    const Fault fault{.name = alone.c_str(),
                      .spoil = silence(length_s),
                      .until_s = kFrom_s + length_s,
                      .recovery_limit_s = 3.0};
    expect_survival(fault, replay(fault.spoil(packets()), nullptr, 0, nullptr));
  }
}

TEST_F(Faults, PacketsInTheWrongOrderOrTwice) {
  expect_survival({.name = "every tenth packet late by 1 to 8 places", .spoil = [](PacketList packets) {
                     std::mt19937_64 random(1);
                     for (std::size_t i = 0; i + 8 < packets.size(); ++i) {
                       if (random() % 10 != 0) continue;
                       const auto place = packets.begin() + static_cast<std::ptrdiff_t>(i);
                       std::rotate(place, place + 1, place + 2 + static_cast<std::ptrdiff_t>(random() % 8));
                     }
                     return packets;
                   }});
  expect_survival({.name = "every packet twice", .spoil = [](const PacketList& packets) {
                     PacketList twice;
                     for (const OwnedPacket& packet : packets) twice.insert(twice.end(), 2, packet);
                     return twice;
                   }});
  expect_survival({.name = "every tenth packet again 5 ms later", .spoil = [](const PacketList& packets) {
                     PacketList echoed;
                     for (std::size_t i = 0; i < packets.size(); ++i) {
                       echoed.push_back(packets[i]);
                       if (i >= 4 && i % 10 == 0) echoed.push_back(packets[i - 4]);
                     }
                     return echoed;
                   }});
}

/// The receiver's clock is set while the sensor drives on. `sensor_off_us`: its own clock is off, so that it
/// is not synchronised.
[[nodiscard]] auto step_clock(std::int64_t leap_ns, std::uint32_t sensor_off_us) {
  return [leap_ns, sensor_off_us](PacketList packets) {
    const std::int64_t from_ns =
        packets.front().packet.receive_utc_ns + static_cast<std::int64_t>(kFrom_s * 1e9);
    for (OwnedPacket& packet : packets) {
      if (packet.packet.receive_utc_ns >= from_ns) packet.packet.receive_utc_ns += leap_ns;
      if (packet.payload.size() != kPayload) continue;
      std::byte* const time = packet.payload.data() + 1200;
      std::uint32_t microseconds = 0;
      for (unsigned i = 0; i < 4; ++i) microseconds |= std::to_integer<std::uint32_t>(time[i]) << 8 * i;
      test::store(time, (microseconds + sensor_off_us) % 3'600'000'000U, 4);
    }
    return packets;
  };
}

TEST_F(Faults, ClockSteps) {
  constexpr std::int64_t kHour_ns = 3600 * platform::kNs_per_s;
  const std::array<std::pair<const char*, std::int64_t>, 6> leaps{
      {{"clock 1 h forward", kHour_ns},
       {"clock 1 h back", -kHour_ns},
       {"clock 1 day forward", 24 * kHour_ns},
       {"clock 1 h 20 min forward", kHour_ns * 4 / 3},
       {"clock 40 s forward", 40 * platform::kNs_per_s},
       {"clock 40 s back", -40 * platform::kNs_per_s}}};
  for (const std::uint32_t sensor_off_us : {0U, 1'234'567'890U}) {
    for (const auto& [name, leap_ns] : variants(leaps)) {
      const std::string full = fmt::format("{}, {} time", name, sensor_off_us == 0 ? "sensor" : "receive");
      expect_survival({.name = full.c_str(),
                       .spoil = step_clock(leap_ns, sensor_off_us),
                       .until_s = kFrom_s,
                       .recovery_limit_s = 1.0,
                       .leap_ns = leap_ns});
    }
  }
}

constexpr std::uint32_t kSensor = 0xC0A801C9;    // 192.168.1.201
constexpr std::uint32_t kStranger = 0xC0A801CA;  // another
/// The drive as that sensor sends it.
[[nodiscard]] PacketList from_sensor(PacketList packets) {
  for (OwnedPacket& packet : packets) packet.packet.source_address = kSensor;
  return packets;
}

/// After each packet in the time of the fault, what `add` makes of it.
template <class Add>
[[nodiscard]] PacketList with_more(const PacketList& packets, Add add) {
  PacketList more;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    more.push_back(packets[i]);
    const std::int64_t since_ns = packets[i].packet.receive_utc_ns - packets.front().packet.receive_utc_ns;
    if (since_ns >= static_cast<std::int64_t>(kFrom_s * 1e9) &&
        since_ns < static_cast<std::int64_t>(kUntil_s * 1e9))
      add(more, i);
  }
  return more;
}

TEST_F(Faults, AnotherSensorOnThePort) {
  expect_survival({.name = "another model on the port", .spoil = [](const PacketList& packets) {
                     return with_more(packets, [](PacketList& more, std::size_t) {
                       OwnedPacket other = more.back();
                       if (other.payload.size() == kPayload)
                         other.payload.back() = std::byte{0x28};  // VLP-32C
                       more.push_back(other);
                     });
                   }});
  expect_survival({.name = "another vendor on the port", .spoil = [](const PacketList& packets) {
                     return with_more(packets, [](PacketList& more, std::size_t) {
                       const test::Pandar64Packet other;
                       more.push_back(more.back());
                       more.back().payload.assign(other.bytes().begin(), other.bytes().end());
                     });
                   }});
  const Fault unit{.name = "another unit of the model, [sensor] address set",
                   .spoil = [](const PacketList& packets) {
                     const PacketList sensor = from_sensor(packets);
                     return with_more(sensor, [&sensor](PacketList& more, std::size_t i) {
                       more.push_back(sensor[(i + sensor.size() / 2) % sensor.size()]);
                       more.back().packet.source_address = kStranger;
                       more.back().packet.receive_utc_ns = sensor[i].packet.receive_utc_ns;
                     });
                   }};
  const ReplayResult result = replay(unit.spoil(packets()), nullptr, kSensor);
  EXPECT_GT(result.pipeline.other_senders, 5000U);
  expect_survival(unit, result);
}

TEST_F(Faults, AFloodOfSmallPackets) {
  const Fault flood{.name = "20 small packets from a stranger to each of the sensor's",
                    .spoil = [](const PacketList& packets) {
                      std::mt19937_64 random(1);
                      return with_more(from_sensor(packets), [&random](PacketList& more, std::size_t) {
                        OwnedPacket small = more.back();
                        small.packet.source_address = kStranger;
                        for (int i = 0; i < 20; ++i) {
                          small.payload.assign(random() % 64, std::byte{0x5A});
                          more.push_back(small);
                        }
                      });
                    }};
  for (const std::uint32_t address : {0U, kSensor}) {
    const ReplayResult result = replay(flood.spoil(packets()), nullptr, address);
    EXPECT_GT(address == 0 ? result.pipeline.rejected() : result.pipeline.other_senders, 100'000U);
    expect_survival(flood, result);
  }
}

/// A bus that takes nothing for some time.
class DownBus final : public platform::FrameSink {
 public:
  DownBus(std::int64_t from_utc_ns, std::int64_t until_utc_ns) : from_(from_utc_ns), until_(until_utc_ns) {}
  [[nodiscard]] std::size_t send(std::span<const platform::CanFrame> group,
                                 std::int64_t stamp_utc_ns) noexcept override {
    if (stamp_utc_ns >= from_ && stamp_utc_ns < until_) return 0;
    ++(stamp_utc_ns < from_ ? before : after);
    return group.size();
  }
  std::size_t before = 0;
  std::size_t after = 0;

 private:
  std::int64_t from_;
  std::int64_t until_;
};

TEST_F(Faults, ABusThatIsDown) {
  const std::int64_t start_ns = packets().front().packet.receive_utc_ns;
  DownBus bus(start_ns + 5 * platform::kNs_per_s, start_ns + 15 * platform::kNs_per_s);
  const Fault fault{.name = "bus down for 10 s", .spoil = [](const PacketList& packets) { return packets; }};
  const ReplayResult result = replay(packets(), &bus);
  expect_survival(fault, result);
  EXPECT_EQ(result.frames_dropped, 100U * 8U + 10U)
      << "six of the pose, latitude and longitude; and LOC_MAP each second";
  EXPECT_GT(bus.before, 40U);
  EXPECT_GT(bus.after, 100U);
}

/// For a child: files may grow to so many bytes, as on a disk that is nearly full.
void fill_disk(rlim_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(Faults, AFullDisk) {
  const std::string log = path("full.log");
  const std::string said = test::in_child([&log] {
    fill_disk(20'000);
    platform::CandumpLog bus(log, "can0");
    const ReplayResult result = replay(packets(), &bus);
    return fmt::format("{} sweeps, all but the first tracking: {}, dropped: {}; {}", result.tally.came(),
                       result.tally.count(ndt::State::tracking) + 1 == result.tally.came(),
                       result.frames_dropped > 100, test::error_of([&bus] {
                         bus.commit();
                         return 0;
                       }));
  });
  fmt::print("disk full under the CAN log: {}\n", said);
  EXPECT_THAT(said, testing::HasSubstr("all but the first tracking: true, dropped: true; "));
  EXPECT_THAT(said, testing::HasSubstr("is the disk full?"));
  EXPECT_FALSE(std::filesystem::exists(log)) << "a log is whole or absent";

  const std::string kept = path("kept.toml");
  platform::save_pose(kept, {.at = {}, .map_checksum = 1});
  const std::string whole = test::text_of(kept);
  const std::string refused = test::in_child([&kept] {
    fill_disk(0);
    return test::error_of([&kept] {
      platform::save_pose(kept, {.at = {}, .map_checksum = 2});
      return 0;
    });
  });
  EXPECT_THAT(refused, testing::HasSubstr("kept.toml: cannot write: File too large"));
  EXPECT_EQ(test::text_of(kept), whole) << "the old one is left";
}

TEST_F(Faults, ACorruptedMap) {
  const std::string sound = test::text_of(path("map.ndt"));
  const ndt::MapHeader header = setup().map().header();
  const ndt::MapLayout layout(header);
  const std::string damaged = path("damaged.ndt");
  const auto refusal = [&](std::size_t offset) {
    std::string bytes = sound;
    bytes[offset] = static_cast<char>(bytes[offset] ^ 0x10);
    std::ofstream(damaged, std::ios::binary) << bytes;
    return test::error_of([&] { return prepare_replay({.config = path("config.toml"), .map = damaged}); });
  };
  for (std::size_t offset = 0; offset < sizeof header; ++offset)
    EXPECT_THAT(refusal(offset), testing::HasSubstr("damaged.ndt: ")) << "header, byte " << offset;
  const std::array<std::pair<const char*, std::array<std::uint64_t, 2>>, 5> regions{
      {{"table", {layout.table, layout.columns}},
       {"columns", {layout.columns, layout.voxels}},
       {"voxels", {layout.voxels, layout.blocks}},
       {"blocks", {layout.blocks, layout.tiles}},
       {"tiles", {layout.tiles, layout.end}}}};
  for (const auto& [name, ends] : regions) {
    for (const std::uint64_t offset : {ends[0], (ends[0] + ends[1]) / 2, ends[1] - 1})
      EXPECT_THAT(refusal(offset), testing::HasSubstr("damaged.ndt: ")) << name << ", byte " << offset;
  }
}

}  // namespace
}  // namespace landfix::tools
