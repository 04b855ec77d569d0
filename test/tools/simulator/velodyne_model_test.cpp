// The simulator's VLP-32C, HDL-32E and VLS-128 against the manuals. What else checks their tables:
//   HDL-32E: the vendor's viewer on a recording (test/real/hdl32e_real_test.cpp), and its two ladders below
//   VLS-128: a driver of others, and walls, on a recording (test/real/vls128_real_test.cpp), and the rule of
//            its rings below; the Alpha Prime has the same table
//   VLP-32C: no recording; two worked numbers, and the spacing of its middle rings below. Offsets of lasers
//            other than those two, and elevations outside the middle, rest on the manual alone.
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "support/lidar_model_probe.hpp"

namespace landfix::tools::simulator {
namespace {

using test::byte_at;
using test::kFullHour_utc_ns;
using test::little_at;
using test::shots_at;

TEST(Velodyne32Model, ReturnsLieWhereTheManualsArithmeticPutsThem) {
  struct Example {
    const char* sensor;
    std::size_t shot;
    double block_azimuth_deg;
    double range_m;
    Eigen::Vector3d point_m;
  };
  const Example examples[] = {{"vlp32c", 9, 270.0, 10.0, {-0.7266, 9.9734, 0.0581}},
                              {"vlp32c", 28, 10.0, 100.0, {96.8356, -24.7121, -3.4899}},
                              {"hdl32e", 31, 180.0, 15.0, {-14.7406, 0.0331, 2.7773}}};
  for (const Example& example : examples) {
    const auto turned_ns = static_cast<std::int64_t>(std::lround(example.block_azimuth_deg / 3600.0 * 1e9));
    const Shot shot = shots_at(example.sensor, kFullHour_utc_ns + turned_ns)[example.shot];
    const Eigen::Vector3d point_m = shot.origin_m + example.range_m * shot.direction();
    EXPECT_LT((point_m - example.point_m).cwiseAbs().maxCoeff(), 2e-4) << example.sensor;
  }
}

TEST(Velodyne32Model, FiresAsTheManualsTimeIt) {
  const auto vlp = shots_at("vlp32c", kFullHour_utc_ns);
  ASSERT_EQ(vlp.size(), 384U);
  EXPECT_EQ(vlp[1].after_ns, 0) << "in pairs";
  EXPECT_EQ(vlp[9].after_ns, 9'216);
  EXPECT_EQ(vlp[31].after_ns, 34'560);
  EXPECT_EQ(vlp[32].after_ns, 55'296);
  const auto hdl = shots_at("hdl32e", kFullHour_utc_ns);
  EXPECT_EQ(hdl[1].after_ns, 1'152) << "singly";
  EXPECT_EQ(hdl[31].after_ns, 35'712);
  EXPECT_EQ(hdl[32].after_ns, 46'080);
  EXPECT_EQ(make_lidar_model("vlp32c")->traits().packet_ns, 663'552);
  EXPECT_EQ(make_lidar_model("hdl32e")->traits().packet_ns, 552'960);
}

TEST(Vls128Model, HasEightAzimuthsThatRepeatWithTheLaser) {
  const auto shots = shots_at("vls128", kFullHour_utc_ns);
  ASSERT_EQ(shots.size(), 384U);
  constexpr double kOffsets_deg[] = {6.354, 4.548, 2.732, 0.911, -0.911, -2.732, -4.548, -6.354};
  std::set<double> elevations_deg;
  for (std::size_t laser = 0; laser < 128; ++laser) {
    const double turned_deg = 3600e-9 * static_cast<double>(shots[laser].after_ns);
    EXPECT_NEAR(shots[laser].azimuth_deg - turned_deg, kOffsets_deg[laser % 8], 1e-9) << laser;
    elevations_deg.insert(shots[laser].elevation_deg);
  }
  EXPECT_EQ(elevations_deg.size(), 128U) << "no two lasers are equally high";
  EXPECT_EQ(*elevations_deg.begin(), -25.0);
  EXPECT_EQ(*elevations_deg.rbegin(), 15.0);
}

TEST(Vls128Model, FiresEightAtOnceAndPausesAfterSixtyFour) {
  const auto shots = shots_at("vls128ap", kFullHour_utc_ns);
  EXPECT_EQ(shots[7].after_ns, 0);
  EXPECT_EQ(shots[8].after_ns, 2'763);
  EXPECT_EQ(shots[63].after_ns, 19'347);  // 7 slots
  EXPECT_EQ(shots[64].after_ns, 24'875);  // 9 slots
  EXPECT_EQ(shots[127].after_ns, 44'222);
  EXPECT_EQ(shots[128].after_ns, 55'278);  // 20 slots
  EXPECT_EQ(make_lidar_model("vls128")->traits().packet_ns, 165'834);
}

TEST(Vls128Model, ReturnsLieWhereTheManualsArithmeticPutsThem) {
  // The manual's slot is 2.665 us, the simulated unit's 2.7639: where the rotor stands when the laser fires
  // is what they have in common.
  struct Example {
    std::size_t laser;
    double block_azimuth_deg;
    double after_us;
    double range_m;
    Eigen::Vector3d point_m;
  };
  const Example examples[] = {{127, 0.50, 42.640, 80.0, {79.6021, 7.9460, 0.6004}},
                              {64, 123.45, 23.985, 4.0, {-2.5530, -3.0543, -0.3917}}};
  for (const Example& example : examples) {
    const double turned_us = example.block_azimuth_deg / 3600e-6 + example.after_us;
    const std::int64_t fired_utc_ns = kFullHour_utc_ns + std::lround(1e3 * turned_us);
    const std::int64_t after_ns = shots_at("vls128", kFullHour_utc_ns)[example.laser].after_ns;
    const Shot shot = shots_at("vls128", fired_utc_ns - after_ns)[example.laser];
    const Eigen::Vector3d point_m = shot.origin_m + example.range_m * shot.direction();
    EXPECT_LT((point_m - example.point_m).cwiseAbs().maxCoeff(), 2e-4) << example.laser;
  }
}

/// By elevation, from the lowest, of the lasers of the first sequence.
std::vector<std::size_t> rings_of(const std::vector<Shot>& shots, std::size_t lasers) {
  std::vector<std::size_t> rings(lasers);
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    for (std::size_t other = 0; other < lasers; ++other) {
      if (shots[other].elevation_deg < shots[laser].elevation_deg) ++rings[laser];
    }
  }
  return rings;
}

TEST(Vls128Model, ScattersItsRingsByOneRule) {
  // No manual says so, but the rings of every eight lasers are those of the first eight, moved on by the bits
  // of the group: an elevation typed wrong by more than its neighbours' distance, or in the wrong row, stands
  // out.
  const auto rings = rings_of(shots_at("vls128", kFullHour_utc_ns), 128);
  for (std::size_t laser = 0; laser < 128; ++laser) {
    const std::size_t group = laser / 8;
    EXPECT_EQ(rings[laser],
              (rings[laser % 8] + 8 * (group % 2) + 32 * (group / 2 % 4) + 16 * (group / 8)) % 128)
        << laser;
  }
}

TEST(Velodyne32Model, TheHdl32eClimbsInTwoLaddersOfFourThirdsOfADegree) {
  const auto shots = shots_at("hdl32e", kFullHour_utc_ns);
  for (std::size_t laser = 0; laser < 32; ++laser) {
    const double foot_deg = laser % 2 == 0 ? -92.0 / 3.0 : -28.0 / 3.0;
    EXPECT_NEAR(shots[laser].elevation_deg, foot_deg + 4.0 / 3.0 * static_cast<double>(laser / 2), 0.005)
        << laser;
  }
}

TEST(Velodyne32Model, TheVlp32cIsFinestInTheMiddle) {
  // The data sheet: a third of a degree apart from ring 8, at -4 deg, to ring 25, at 1.667.
  const auto shots = shots_at("vlp32c", kFullHour_utc_ns);
  const auto rings = rings_of(shots, 32);
  for (std::size_t laser = 0; laser < 32; ++laser) {
    if (rings[laser] < 8 || rings[laser] > 25) continue;
    EXPECT_NEAR(shots[laser].elevation_deg, -4.0 + static_cast<double>(rings[laser] - 8) / 3.0, 0.001)
        << laser;
  }
  EXPECT_EQ(std::set<std::size_t>(rings.begin(), rings.end()).size(), 32U);
}

TEST(VelodyneModels, PutEveryFieldWhereTheManualsSay) {
  struct Sensor {
    const char* name;
    unsigned product;
    double range_unit_m;
    unsigned time_us;
  };
  for (const Sensor& sensor :
       {Sensor{"vlp32c", 0x28, 0.004, 1'234'567}, Sensor{"hdl32e", 0x21, 0.002, 1'234'567},
        Sensor{"vls128", 0xA1, 0.004, 1'234'575}}) {
    const auto model = make_lidar_model(sensor.name);
    std::vector<Echo> echoes(model->traits().shots_per_packet);
    echoes[32] = {.range_m = 20.0, .reflectivity = 77};
    const auto payload = model->encode(0, kFullHour_utc_ns + 1'234'567'000, echoes);
    ASSERT_EQ(payload.size(), 1206U);
    EXPECT_EQ(little_at(payload, 0, 2), 0xEEFFU);
    EXPECT_EQ(little_at(payload, 100, 2), std::string_view(sensor.name) == "vls128" ? 0xDDFFU : 0xEEFFU);
    EXPECT_EQ(little_at(payload, 104, 2), static_cast<unsigned>(std::lround(20.0 / sensor.range_unit_m)));
    EXPECT_EQ(byte_at(payload, 106), 77U);
    EXPECT_EQ(little_at(payload, 1200, 4), sensor.time_us) << sensor.name;
    EXPECT_EQ(byte_at(payload, 1204), 0x37U);
    EXPECT_EQ(byte_at(payload, 1205), sensor.product);
  }
  const auto vls128 = make_lidar_model("vls128");
  const auto payload = vls128->encode(0, kFullHour_utc_ns, std::vector<Echo>(384));
  constexpr unsigned kFlags[] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(little_at(payload, 100 * block, 2), kFlags[block % 4]);
    EXPECT_EQ(little_at(payload, 100 * block + 2, 2), little_at(payload, 100 * (block / 4 * 4) + 2, 2))
        << "the banks of a sequence share an azimuth";
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
