// The HDL-64E of the simulator against the manuals, and what its packets say of themselves against the file.
// Independent checks of the same geometry: the vendor's viewer on recorded packets of an S1
// (test/real/hdl64_real_test.cpp) and numbers worked by hand (test/drivers/hdl64_decoder_test.cpp); of the
// checksum: the published check value of its CRC (drivers/velodyne/hdl64_status.cpp). No recording of an S2
// or S3 was to be had.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/decoder_bench.hpp"
#include "support/lidar_model_probe.hpp"
#include "tools/simulator/hdl64_unit.hpp"

namespace landfix::tools::simulator {
namespace {

using test::byte_at;
using test::calibration_of;
using test::kFullHour_utc_ns;
using test::little_at;
using test::shots_at;

constexpr std::size_t kSetPackets = 4160;

TEST(Hdl64Model, FiresAsTheManualTimesIt) {
  const auto shots = shots_at("hdl64s2", kFullHour_utc_ns);
  ASSERT_EQ(shots.size(), 384U);
  EXPECT_EQ(shots[1].after_ns, 1'260);
  EXPECT_EQ(shots[7].after_ns, 9'660);
  EXPECT_EQ(shots[31].after_ns, 45'660);
  EXPECT_EQ(shots[32].after_ns, 0) << "the lower block fires with the upper one";
  EXPECT_EQ(shots[64].after_ns, 48'000);
  EXPECT_EQ(make_lidar_model("hdl64s3")->traits().packet_ns, 288'000);  // 3472.2 packets a second
  EXPECT_EQ(make_lidar_model("hdl64s1")->traits().packet_ns, 384'000);
}

TEST(Hdl64Model, TheUnitIsSmoothAndLikeRealOnes) {
  for (const Hdl64UnitLaser& laser : hdl64_unit()) {
    EXPECT_GE(laser.elevation_centideg, -2460);
    EXPECT_LE(laser.elevation_centideg, 220);
    EXPECT_LT(std::abs(laser.rotation_centideg), 900);
    EXPECT_NEAR(laser.range_mm, 1350, 100);
    EXPECT_NEAR(laser.height_mm, 155, 60);
    EXPECT_EQ(std::abs(laser.left_mm), 26);
  }
}

TEST(Hdl64Model, APointLiesWhereTheManualsArithmeticPutsIt) {
  const auto unit = hdl64_unit();
  const Shot shot = shots_at("hdl64s2", kFullHour_utc_ns + 25'000'000)[0];
  EXPECT_NEAR(shot.azimuth_deg, 90.0 - 0.01 * unit[0].rotation_centideg, 1e-9);
  // x right, y forward, as the manual writes them.
  const double theta = shot.azimuth_deg * M_PI / 180.0;
  const double omega = 0.01 * unit[0].elevation_centideg * M_PI / 180.0;
  const double measured_m = 9.0;
  const double range_m = measured_m + 1e-3 * unit[0].range_mm;
  const double h_m = 1e-3 * unit[0].left_mm;
  const double x_m = range_m * std::cos(omega) * std::sin(theta) - h_m * std::cos(theta);
  const double y_m = range_m * std::cos(omega) * std::cos(theta) + h_m * std::sin(theta);
  const double z_m = range_m * std::sin(omega) + 1e-3 * unit[0].height_mm;
  const Eigen::Vector3d point_m = shot.origin_m + range_m * shot.direction();
  EXPECT_LT((point_m - Eigen::Vector3d(y_m, -x_m, z_m)).norm(), 1e-9);
}

TEST(Hdl64Model, PutsEveryFieldWhereTheManualSays) {
  std::vector<Echo> echoes(384);
  const double correction_m = 1e-3 * hdl64_unit()[0].range_mm;
  echoes[0] = {.range_m = 0x1234 * 0.002 + correction_m, .reflectivity = 0x5A};
  const auto s2 = make_lidar_model("hdl64s2")->encode(16, kFullHour_utc_ns + 25'000'000, echoes);
  ASSERT_EQ(s2.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(byte_at(s2, 100 * block), 0xFFU);
    EXPECT_EQ(byte_at(s2, 100 * block + 1), block % 2 == 0 ? 0xEEU : 0xDDU);
    const std::uint64_t azimuth = little_at(s2, 100 * block + 2, 2);
    EXPECT_EQ(azimuth, 9000U + static_cast<unsigned>(std::lround(17.28 * static_cast<double>(block / 2))));
  }
  EXPECT_EQ(byte_at(s2, 4), 0x34U);
  EXPECT_EQ(byte_at(s2, 5), 0x12U);
  EXPECT_EQ(byte_at(s2, 6), 0x5AU);
  EXPECT_EQ(little_at(s2, 1200, 2), 25'288U) << "the time of the packet's end";
  EXPECT_EQ(byte_at(s2, 1204), 'H');
  EXPECT_EQ(byte_at(s2, 1205), 8U);
  const auto s1 = make_lidar_model("hdl64s1")->encode(0, kFullHour_utc_ns, echoes);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(byte_at(s1, 100 * block + 1), block % 4 == 0 ? 0xDDU : 0xEEU);
  }
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(&s1[1200]), 6), "Q DegC");
}

TEST(Hdl64Model, TheS1ShowsTheNearestOf4000Steps) {
  const auto s1 = make_lidar_model("hdl64s1");
  const std::vector<Echo> none(384);
  double sum_centideg = 0.0;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const std::int64_t turned_ns = i * 98'765;  // a turn, not in step with the encoder
    const auto azimuth =
        static_cast<double>(little_at(s1->encode(0, kFullHour_utc_ns + turned_ns, none), 2, 2));
    ASSERT_LT(azimuth, 36000.0);
    ASSERT_EQ(std::fmod(azimuth, 9.0), 0.0);
    const double off_centideg = std::remainder(azimuth - 0.36e-3 * static_cast<double>(turned_ns), 36000.0);
    ASSERT_LE(std::abs(off_centideg), 4.5) << i;
    sum_centideg += off_centideg;
  }
  EXPECT_NEAR(sum_centideg / 1000.0, 0.0, 0.2) << "neither ahead nor behind on average";
}

/// Packets of a sensor that sees the same everywhere.
class Stream {
 public:
  explicit Stream(std::string_view sensor)
      : lidar_(make_lidar_model(sensor)), echoes_(384, {.range_m = 12.0, .reflectivity = 50}) {}

  [[nodiscard]] std::vector<std::byte> payload(std::size_t i) const {
    return lidar_->encode(i, utc_ns(i), echoes_);
  }
  [[nodiscard]] std::int64_t utc_ns(std::size_t i) const {
    return kFullHour_utc_ns + static_cast<std::int64_t>(i) * lidar_->traits().packet_ns;
  }
  [[nodiscard]] const LidarModel& lidar() const { return *lidar_; }

 private:
  std::unique_ptr<LidarModel> lidar_;
  std::vector<Echo> echoes_;
};

test::DecoderBench bench_of(const char* sensor, const drivers::Calibration& calibration) {
  return test::DecoderBench(sensor, {}, 200'000, calibration);
}

class InStream : public testing::TestWithParam<const char*> {};

TEST_P(InStream, TheUnitsOwnBytesCalibrateItAsWellAsItsFile) {
  const Stream stream(GetParam());
  auto by_file = bench_of(GetParam(), calibration_of(stream.lidar()));
  auto by_stream = bench_of(GetParam(), {});
  constexpr std::size_t kFirst = 1234;  // in the middle of a set
  constexpr std::size_t kCalibrated = 2 * kSetPackets - 1;
  for (std::size_t i = kFirst; i < kCalibrated + 800; ++i) {
    const auto payload = stream.payload(i);
    const std::int64_t receive_utc_ns = stream.utc_ns(i + 1) + 300'000;
    ASSERT_EQ(by_file.decode(payload, receive_utc_ns).status, drivers::DecodeStatus::decoded) << i;
    ASSERT_EQ(by_stream.decode(payload, receive_utc_ns).status,
              i < kCalibrated ? drivers::DecodeStatus::uncalibrated : drivers::DecodeStatus::decoded)
        << i;
  }
  ASSERT_EQ(by_stream.swept().size(), 3U);
  const auto& expected = by_file.swept().back().points;
  const auto& points = by_stream.swept().back().points;
  ASSERT_TRUE(by_stream.swept().back().complete);
  ASSERT_EQ(points.size(), expected.size());
  ASSERT_GT(points.size(), 100'000U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f apart(points[i].x - expected[i].x, points[i].y - expected[i].y,
                                points[i].z - expected[i].z);
    // The estimates of the speed began at different times.
    ASSERT_LT(apart.norm(), 1e-4F) << i;
    ASSERT_EQ(points[i].ring, expected[i].ring);
    ASSERT_EQ(points[i].intensity, expected[i].intensity);
  }
}

TEST_P(InStream, ALostPacketDelaysTheCalibrationByASet) {
  const Stream stream(GetParam());
  auto bench = bench_of(GetParam(), {});
  std::size_t calibrated = 0;
  for (std::size_t i = 0; i < 3 * kSetPackets && calibrated == 0; ++i) {
    if (i == 2010) continue;
    const auto status = bench.decode(stream.payload(i), stream.utc_ns(i + 1)).status;
    if (status == drivers::DecodeStatus::decoded) calibrated = i;
  }
  EXPECT_EQ(calibrated, 2 * kSetPackets - 1);
}

TEST_P(InStream, SatellitesSayTheHourWhateverTheReceiversClockShows) {
  const Stream stream(GetParam());
  auto bench = bench_of(GetParam(), calibration_of(stream.lidar()));
  constexpr std::int64_t kWrongBy_ns = 123'456'789'000'000;  // 34 hours
  for (std::size_t i = 0; i < 1000; ++i) {
    static_cast<void>(bench.decode(stream.payload(i), stream.utc_ns(i + 1) - kWrongBy_ns));
  }
  ASSERT_FALSE(bench.swept().empty());
  const auto& sweep = bench.swept().back();
  EXPECT_TRUE(sweep.complete);
  EXPECT_EQ(sweep.time_source, drivers::TimeSource::sensor);
  EXPECT_NEAR(static_cast<double>(sweep.start_utc_ns - kFullHour_utc_ns),
              1e8 * std::round(1e-8 * static_cast<double>(sweep.start_utc_ns - kFullHour_utc_ns)), 60'000.0);
  EXPECT_LT(sweep.start_utc_ns, stream.utc_ns(1000));
  EXPECT_GT(sweep.start_utc_ns, stream.utc_ns(0));
}

INSTANTIATE_TEST_SUITE_P(Both, InStream, testing::Values("hdl64s2", "hdl64s3"),
                         [](const auto& sensor) { return std::string(sensor.param); });

}  // namespace
}  // namespace landfix::tools::simulator
