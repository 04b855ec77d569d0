#include "drivers/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "support/synthetic_packets.hpp"

namespace landfix::drivers {
namespace {

TEST(SensorModel, RingsRankTheElevationsOfEveryTable) {
  for (const SensorModel& model : sensor_models()) {
    if (model.beams.empty()) continue;  // every unit has its own
    std::vector<double> by_ring(model.beams.size(), 1e9);
    for (const Beam& beam : model.beams) by_ring.at(beam.ring) = beam.elevation_deg;
    EXPECT_TRUE(std::is_sorted(by_ring.begin(), by_ring.end())) << model.name;
    EXPECT_LT(by_ring.back(), 1e9) << model.name << ": a ring has no beam";
    EXPECT_NEAR(by_ring.back(), model.vertical_up_deg, 0.2) << model.name;
    EXPECT_NEAR(by_ring.front(), model.vertical_down_deg, 0.2) << model.name;
  }
}

TEST(SensorModel, NamesAreUniqueAndFound) {
  for (const SensorModel& model : sensor_models()) EXPECT_EQ(find_sensor_model(model.name), &model);
  EXPECT_EQ(find_sensor_model("vlp17"), nullptr);
  EXPECT_EQ(find_sensor_model(""), nullptr);
}

TEST(SensorModel, HoldsASweepOfDualReturnsAtTheSlowestRotation) {
  EXPECT_GT(find_sensor_model("vlp16")->max_points_per_sweep(), 115'741U);
  EXPECT_GT(find_sensor_model("pandar64")->max_points_per_sweep(), 230'400U);
  EXPECT_GT(find_sensor_model("hdl64s1")->max_points_per_sweep(), 200'000U);
  EXPECT_GT(find_sensor_model("hdl64s2")->max_points_per_sweep(), 266'667U);
  EXPECT_GT(find_sensor_model("hdl64s3")->max_points_per_sweep(), 444'445U);
  EXPECT_GT(find_sensor_model("pandar40p")->max_points_per_sweep(), 144'000U);
  EXPECT_GT(find_sensor_model("os1-64")->max_points_per_sweep(), 2U * 64U * 2048U);
}

TEST(SensorModel, IsRecognisedByItsOwnPacketsOnly) {
  const test::VelodynePacket puck(0x22);
  const test::VelodynePacket hires(0x24);
  const test::Pandar64Packet pandar;
  const test::Pandar40pPacket pandar40p;
  test::Pandar40pPacket unmarked;
  unmarked.set_byte(9 * 124, 0xEE);
  const auto looks = [](const char* name, std::span<const std::byte> payload) {
    return looks_like(*find_sensor_model(name), payload);
  };
  EXPECT_TRUE(looks("vlp16", puck.bytes()));
  EXPECT_FALSE(looks("vlp16", hires.bytes()));
  EXPECT_TRUE(looks("vlp16hires", hires.bytes()));
  EXPECT_TRUE(looks("hdl32e", test::VelodynePacket(0x21).bytes()));
  EXPECT_TRUE(looks("vlp32c", test::VelodynePacket(0x28).bytes()));
  test::VelodynePacket alpha(0xA1);
  EXPECT_FALSE(looks("vls128", alpha.bytes())) << "its flags are those of blocks of 32 lasers";
  constexpr std::array<std::uint16_t, 4> kFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  for (std::size_t block = 0; block < 12; ++block) alpha.set_flag(block, kFlags[block % 4]);
  EXPECT_TRUE(looks("vls128", alpha.bytes()));
  EXPECT_TRUE(looks("vls128ap", alpha.bytes()));
  alpha.set_product(0x63);
  EXPECT_TRUE(looks("vls128", alpha.bytes())) << "the id that another manual prints";
  // The last byte of an HDL-64E may be any; its blocks alternate between the upper and the lower half.
  test::VelodynePacket hdl64(0x22);
  for (std::size_t block = 0; block < 12; ++block) hdl64.set_flag(block, kFlags[block % 2]);
  EXPECT_FALSE(looks("vlp16", hdl64.bytes()));
  EXPECT_TRUE(looks("pandar64", pandar.bytes()));
  EXPECT_FALSE(looks("pandar64", puck.bytes()));
  EXPECT_FALSE(looks("pandar64", pandar40p.bytes()));
  EXPECT_TRUE(looks("pandar40p", pandar40p.bytes()));
  EXPECT_TRUE(looks("pandar40p", test::Pandar40pPacket(0x39, 1).bytes()));
  EXPECT_FALSE(looks("pandar40p", pandar40p.bytes().first(1256)));
  EXPECT_FALSE(looks("pandar40p", unmarked.bytes()));
  EXPECT_FALSE(looks("pandar40p", pandar.bytes()));
  EXPECT_FALSE(looks("pandar40p", puck.bytes()));
  EXPECT_FALSE(looks("vlp16", pandar.bytes()));
  EXPECT_FALSE(looks("vlp16", puck.bytes().first(1205)));
  EXPECT_FALSE(looks("vlp16", {}));
}

}  // namespace
}  // namespace landfix::drivers
