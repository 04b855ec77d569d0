#include "tools/budget_report.hpp"

#include <bit>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/packet_rate.hpp"
#include "platform/place_search.hpp"

namespace landfix::tools {
namespace {

using platform::Budget;
using platform::Configuration;
using testing::HasSubstr;

constexpr std::uint64_t kMib = 1 << 20;

const drivers::SensorModel& model(std::string_view name) { return *drivers::find_sensor_model(name); }

std::map<std::string_view, double> rates_of(const Budget& budget) {
  std::map<std::string_view, double> rates;
  for (const auto& row : budget.rates) rates[row.name] = row.value;
  return rates;
}

std::uint64_t memory_of(const Budget& budget, std::string_view name) {
  for (const auto& row : budget.memory) {
    if (row.name == name) return row.bytes;
  }
  return 0;
}

TEST(PacketRate, IsThatOfTheDataSheets) {
  EXPECT_NEAR(platform::packets_per_s(model("vlp16")) / model("vlp16").max_returns, 754.0, 1.0);
  EXPECT_NEAR(platform::packets_per_s(model("vls128")), 18'800.0, 200.0);
  EXPECT_NEAR(platform::packets_per_s(model("os1-64")), 1280.0, 1.0);
}

TEST(PacketRate, TheRingHoldsAQuarterSecondOfEverySensor) {
  platform::PlaceSearch search{ndt::VoxelMap()};
  search.prepare();
  const std::uint64_t search_bytes = search.memory_bytes();
  for (const drivers::SensorModel& sensor : drivers::sensor_models()) {
    const std::size_t slots = platform::packet_ring_slots(sensor);
    EXPECT_TRUE(std::has_single_bit(slots)) << sensor.name;
    EXPECT_GE(static_cast<double>(slots), platform::packets_per_s(sensor) * 0.25) << sensor.name;
    EXPECT_LT(static_cast<double>(slots), platform::packets_per_s(sensor) * 0.5 + 2.0) << sensor.name;
    EXPECT_GE(platform::largest_packet_bytes(sensor), 1000U) << sensor.name;
    EXPECT_GE(platform::receive_buffer_bytes(sensor), 4 * kMib) << sensor.name;
    // VLS-128 takes the most, for two sweeps of 1.5 turns at 5 Hz with both returns.
    EXPECT_LE(platform::budget_of({}, sensor, 0, search_bytes).memory_bytes(), 64 * kMib) << sensor.name;
  }
}

TEST(Budget, FollowsTheConfiguration) {
  Configuration configuration;
  configuration.realtime.solve = {.priority = 60, .core = 3};
  configuration.can.rate_hz = 50.0;
  const Budget budget = platform::budget_of(configuration, model("vlp16"), 100 * kMib, kMib);
  ASSERT_EQ(budget.threads.size(), 6U);
  EXPECT_EQ(budget.threads[1].name, "solve");
  EXPECT_EQ(budget.threads[1].priority, 60);
  EXPECT_EQ(budget.threads[1].core, 3);
  EXPECT_EQ(budget.threads[2].deadline_ms, 20.0);
  EXPECT_EQ(memory_of(budget, "map"), 100 * kMib);
  EXPECT_EQ(memory_of(budget, "place search"), kMib);
  EXPECT_EQ(rates_of(budget)["CAN frames"], 300.0);
  EXPECT_NEAR(rates_of(budget)["bus load at 500 kbit/s"], 300.0 * 135.0 / 5000.0, 1e-9);

  configuration.map.memory_mib = 64;
  configuration.can.fd = true;
  configuration.realtime.mode = platform::RealtimeMode::off;
  const Budget other = platform::budget_of(configuration, model("vlp16"), 100 * kMib, kMib);
  EXPECT_EQ(memory_of(other, "map"), 64 * kMib);
  EXPECT_EQ(rates_of(other)["CAN frames"], 50.0);
  EXPECT_EQ(other.threads[0].priority, 0);
}

TEST(Budget, ReadsAsATableAndAsJson) {
  const Budget budget = platform::budget_of({}, model("os1-64"), kMib, kMib);
  const std::string text = to_text(budget);
  EXPECT_THAT(text, HasSubstr("solve    FIFO         70   any"));
  EXPECT_THAT(text, HasSubstr("bus load at 500 kbit/s"));
  const auto json = to_json(budget);
  EXPECT_EQ(json["threads"].size(), 6U);
  EXPECT_EQ(json["memory_bytes"], budget.memory_bytes());
}

}  // namespace
}  // namespace landfix::tools
