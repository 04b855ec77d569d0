// The simulator's VLP-32C, HDL-32E and VLS-128 against the manuals. Their tables are checked by data of
// others too: clouds that the vendor's viewer and a driver decoded from recordings (test/real), and the
// numbers below.
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tools/simulator/lidar_model.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr std::int64_t kFullHour_utc_ns = 1'777'881'600'000'000'000;

unsigned byte_at(const auto& payload, std::size_t at) { return std::to_integer<unsigned>(payload[at]); }
unsigned word_at(const auto& payload, std::size_t at) {
  return byte_at(payload, at) | byte_at(payload, at + 1) << 8;
}

std::vector<Shot> shots_at(const char* name, std::int64_t utc_ns) {
  const auto model = make_lidar_model(name);
  std::vector<Shot> shots(model->traits().shots_per_packet);
  model->aim(utc_ns, shots);
  return shots;
}

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
    EXPECT_EQ(word_at(payload, 0), 0xEEFFU);
    EXPECT_EQ(word_at(payload, 100), std::string_view(sensor.name) == "vls128" ? 0xDDFFU : 0xEEFFU);
    EXPECT_EQ(word_at(payload, 104), static_cast<unsigned>(std::lround(20.0 / sensor.range_unit_m)));
    EXPECT_EQ(byte_at(payload, 106), 77U);
    EXPECT_EQ(word_at(payload, 1200) | word_at(payload, 1202) << 16, sensor.time_us) << sensor.name;
    EXPECT_EQ(byte_at(payload, 1204), 0x37U);
    EXPECT_EQ(byte_at(payload, 1205), sensor.product);
  }
  const auto vls128 = make_lidar_model("vls128");
  const auto payload = vls128->encode(0, kFullHour_utc_ns, std::vector<Echo>(384));
  constexpr unsigned kFlags[] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(word_at(payload, 100 * block), kFlags[block % 4]);
    EXPECT_EQ(word_at(payload, 100 * block + 2), word_at(payload, 100 * (block / 4 * 4) + 2))
        << "the banks of a sequence share an azimuth";
  }
}

}  // namespace
}  // namespace landfix::tools::simulator
