// After start-up no decoder touches the heap: every sensor of the simulator, over a turn and its cuts.
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/make_decoder.hpp"
#include "platform/heap_counter.hpp"
#include "support/lidar_model_probe.hpp"

namespace landfix::tools::simulator {
namespace {

using platform::HeapCounter;

constexpr std::int64_t kStart_utc_ns = 1'777'882'500'037'000'000;
constexpr std::int64_t kDuration_ns = 250'000'000;

class DecodeAllocatesNothing : public testing::TestWithParam<std::string_view> {};

TEST_P(DecodeAllocatesNothing, FromTheFirstPacketToTheLast) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap cannot be counted: a sanitizer, or not glibc";
  const auto lidar = make_lidar_model(GetParam());
  const LidarTraits& traits = lidar->traits();
  std::vector<std::vector<std::byte>> packets;
  std::vector<Echo> echoes(traits.shots_per_packet);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    echoes[i] = {.range_m = i % 7 == 0 ? 0.0 : 5.0 + 0.01 * static_cast<double>(i), .reflectivity = 9};
  }
  for (std::int64_t at_ns = 0; at_ns < kDuration_ns; at_ns += traits.packet_ns) {
    packets.push_back(lidar->encode(packets.size(), kStart_utc_ns + at_ns, echoes));
  }
  std::vector<std::byte> telemetry;
  if (traits.telemetry_port != 0) telemetry = lidar->encode_telemetry({.utc_ns = kStart_utc_ns});

  const drivers::SensorModel& model = *drivers::find_sensor_model(GetParam());
  drivers::AnyDecoder decoder = drivers::make_decoder(model, {}, test::calibration_of(*lidar));
  std::vector<drivers::Point> storage(2 * model.max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  std::size_t points = 0;
  std::size_t completed = 0;
  std::int64_t receive_utc_ns = kStart_utc_ns;

  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  if (!telemetry.empty()) static_cast<void>(decoder.decode({telemetry, receive_utc_ns}, sweeps));
  for (const auto& packet : packets) {
    receive_utc_ns += traits.packet_ns;
    if (!decoder.decode({packet, receive_utc_ns}, sweeps).sweep_completed) continue;
    ++completed;
    points += sweeps.completed().points().size();
  }
  static_cast<void>(decoder.flush(sweeps));
  HeapCounter::disarm();
  EXPECT_EQ(HeapCounter::calls() - before, 0U);
  EXPECT_GE(completed, 2U);
  EXPECT_GT(points, 1000U);
}

INSTANTIATE_TEST_SUITE_P(EverySensor, DecodeAllocatesNothing, testing::ValuesIn(lidar_model_names()),
                         [](const auto& sensor) {
                           std::string name(sensor.param);
                           std::erase(name, '-');
                           return name;
                         });

TEST(DecodeAllocatesNothingGate, SeesAnAllocation) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap cannot be counted: a sanitizer, or not glibc";
  const std::uint64_t before = HeapCounter::calls();
  HeapCounter::arm();
  const std::vector<int> seeded(1000);
  HeapCounter::disarm();
  EXPECT_GT(HeapCounter::calls() - before, 0U);
  EXPECT_EQ(seeded.size(), 1000U);
}

}  // namespace
}  // namespace landfix::tools::simulator
