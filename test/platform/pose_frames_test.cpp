#include "platform/pose_frames.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/frames.hpp"
#include "support/random_pose_report.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

ndt::Fix fix_at(const Eigen::Vector3d& place_m, const ndt::RollPitchYaw& angles) {
  ndt::Fix fix;
  fix.at = {.stamp_utc_ns = 1'700'000'000'000'000'000, .pose = ndt::make_pose(place_m, angles)};
  fix.state = ndt::State::tracking;
  fix.covariance = ndt::Matrix6::Zero();
  return fix;
}

PoseReport report_at(double x_m, std::int64_t stamp_utc_ns = 1'700'000'000'000'000'000) {
  PoseReport report = report_of(fix_at({x_m, 0.0, 0.0}, {}), drivers::TimeSource::sensor, true);
  report.stamp_utc_ns = stamp_utc_ns;
  return report;
}

TEST(PoseFrames, AreTheGoldenFramesOfClassicCan) {
  PoseReport report;
  report.x_m = 1234.567;
  report.y_m = -89.012;
  report.yaw_rad = 1.5708;
  report.pitch_rad = -0.0123;
  report.roll_rad = 0.0045;
  const CanFrame position = encode_frame(kFrameLayouts[0], 0x3A0, 3, report);
  EXPECT_EQ(position.id, 0x3A0U);
  EXPECT_FALSE(position.fd);
  EXPECT_TRUE(same(position.payload(), bytes({0x47, 0x13, 0x87, 0xD6, 0x12, 0x4C, 0xA4, 0xFE})));
  const CanFrame attitude = encode_frame(kFrameLayouts[1], 0x3A0, 3, report);
  EXPECT_EQ(attitude.id, 0x3A1U);
  EXPECT_TRUE(same(attitude.payload(), bytes({0xFE, 0x13, 0x5C, 0x3D, 0x85, 0xFF, 0x2D, 0x00})));
}

// From another implementation: Python's struct and a bitwise CRC.
TEST(PoseFrames, AreTheGoldenFrameOfCanFd) {
  PoseReport report;
  report.stamp_utc_ns = 1'700'000'000'123'456'789;
  report.x_m = 1234.5678;
  report.y_m = -89.0123;
  report.z_m = -3.25;
  report.roll_rad = 0.0045;
  report.pitch_rad = -0.0123;
  report.yaw_rad = 1.5708;
  report.speed_x_mps = 13.89;
  report.speed_y_mps = -0.25;
  report.speed_z_mps = 0.015;
  report.roll_rate_radps = 0.002;
  report.pitch_rate_radps = -0.004;
  report.yaw_rate_radps = 0.321;
  report.sigma_along_m = 0.021;
  report.sigma_cross_m = 0.009;
  report.sigma_up_m = 0.034;
  report.sigma_roll_rad = 0.0008;
  report.sigma_pitch_rad = 0.0006;
  report.sigma_yaw_rad = 0.0003;
  report.state = 4;
  report.time_source = 1;
  report.weak = 1;
  report.iterations = 12;
  report.score = 0.7;
  report.age_s = 0.0125;
  const CanFrame pose = encode_frame(kFrameLayouts[kFdPoseFrameIndex], 0x3A0, 0xC8, report);
  EXPECT_EQ(pose.id, 0x3A9U);
  EXPECT_TRUE(pose.fd);
  EXPECT_TRUE(pose.bit_rate_switch);
  EXPECT_TRUE(same(pose.payload(),
                   bytes({0x8C, 0x76, 0xC8, 0x15, 0xCD, 0x85, 0x3D, 0xFE, 0x9C, 0x97, 0x17, 0x4E, 0x61,
                          0xBC, 0x00, 0xF5, 0x6A, 0xF2, 0xFF, 0x0C, 0x81, 0xFF, 0xFF, 0xC8, 0xAF, 0x00,
                          0x00, 0x88, 0x1F, 0xFE, 0xFF, 0x60, 0xAF, 0xEF, 0x00, 0xDA, 0x0A, 0xCE, 0xFF,
                          0x03, 0x00, 0x02, 0x00, 0xFC, 0xFF, 0x41, 0x01, 0x15, 0x00, 0x09, 0x00, 0x22,
                          0x00, 0x08, 0x00, 0x06, 0x00, 0x03, 0x00, 0x94, 0x0C, 0xAF, 0x7D, 0x00})));
}

TEST(PoseFrames, DecodeToWithinHalfAStep) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 5000; ++round) {
    for (const FrameLayout& layout : kFrameLayouts) {
      const PoseReport report = random_report(random, std::span(&layout, 1));
      PoseReport received;
      decode_frame(layout, encode_frame(layout, 0x100, 0, report).payload(), received);
      for (const Signal& signal : layout.signals) {
        if (const auto* number = std::get_if<double PoseReport::*>(&signal.field)) {
          EXPECT_NEAR(received.**number, report.**number, 0.5 * signal.scale * (1 + 1e-6)) << signal.name;
        } else if (const auto* code = std::get_if<std::uint16_t PoseReport::*>(&signal.field)) {
          EXPECT_EQ(received.**code, report.**code) << signal.name;
        } else {
          EXPECT_LE(std::abs(received.stamp_utc_ns - report.stamp_utc_ns), std::llround(0.5e9 * signal.scale))
              << signal.name;
        }
      }
    }
  }
}

TEST(PoseFrames, OfOnePoseShareACounterThatCountsPoses) {
  for (const bool fd : {false, true}) {
    PoseFrameEncoder encoder(0x200, fd);
    const unsigned end = fd ? 256 : 15;
    for (unsigned i = 0; i < 300; ++i) {
      const PoseFrames sent = encoder.encode(report_at(i));
      ASSERT_EQ(sent.count, pose_layouts(fd).size() + (i == 0 ? 1 : 0));
      for (std::size_t f = 0; f < pose_layouts(fd).size(); ++f) {
        const CanFrame& frame = sent.frames[f];
        EXPECT_EQ(frame.id, 0x200U + pose_layouts(fd)[f].id_offset);
        const unsigned counter = fd ? std::to_integer<unsigned>(frame.data[2])
                                    : std::to_integer<unsigned>(frame.data[1] & std::byte{0x0F});
        EXPECT_EQ(counter, i % end);
      }
    }
  }
}

TEST(PoseFrames, TheMapIsNamedOnceASecondAndAgainAfterTheClockWasSetBack) {
  PoseFrameEncoder encoder(0x200, false);
  const auto names_map = [&](std::int64_t ms) {
    const PoseFrames frames = encoder.encode(report_at(0.0, ms * 1'000'000));
    return frames.all().back().id == 0x208;
  };
  EXPECT_TRUE(names_map(5'000));
  EXPECT_FALSE(names_map(5'970));
  EXPECT_TRUE(names_map(6'000));
  EXPECT_FALSE(names_map(6'100));
  EXPECT_TRUE(names_map(1'000));
  EXPECT_FALSE(names_map(1'100));
}

// From another implementation: Python's integers and a bitwise CRC.
TEST(PoseFrames, AreTheGoldenFramesOfLatitudeAndLongitude) {
  PoseReport report;
  report.latitude_deg = 35.6866094838141;
  report.longitude_deg = -139.67382014173123;
  report.utm_zone = 54;
  report.state = 5;
  const CanFrame latitude = encode_frame(kFrameLayouts[kLatitudeFrameIndex], 0x3A0, 3, report);
  EXPECT_EQ(latitude.id, 0x3A6U);
  EXPECT_TRUE(same(latitude.payload(), bytes({0x57, 0x13, 0x1B, 0x8B, 0x8C, 0x60, 0x19, 0x36})));
  const CanFrame longitude = encode_frame(kFrameLayouts[kLongitudeFrameIndex], 0x3A0, 3, report);
  EXPECT_EQ(longitude.id, 0x3A7U);
  EXPECT_TRUE(same(longitude.payload(), bytes({0x47, 0x13, 0xBC, 0x31, 0x28, 0xAD, 0x9C, 0x05})));
}

TEST(PoseFrames, LatitudeAndLongitudeComeTenTimesASecondAfterThePose) {
  for (const bool fd : {false, true}) {
    PoseFrameEncoder encoder(0x200, fd, true);
    PoseFrameEncoder without(0x200, fd);
    const std::size_t pose_frames = pose_layouts(fd).size();
    int sent = 0;
    for (int i = 0; i < 100; ++i) {
      const PoseReport report = report_at(0.0, 1'700'000'000'000'000'000 + i * 10'000'000);
      const PoseFrames frames = encoder.encode(report);
      EXPECT_EQ(frames.count - without.encode(report).count, i % 8 == 0 ? 2U : 0U);
      if (i % 8 != 0) continue;
      const unsigned counter = static_cast<unsigned>(sent++ % 15);
      for (std::size_t f = 0; f < 2; ++f) {
        const CanFrame& frame = frames.frames[pose_frames + f];
        EXPECT_EQ(frame.id, 0x206U + f);
        EXPECT_EQ(std::to_integer<unsigned>(frame.data[1] & std::byte{0x0F}), counter);
      }
    }
  }
}

TEST(PoseFrames, SayThatAValueWasClamped) {
  for (const bool fd : {false, true}) {
    PoseFrameEncoder encoder(0x200, fd);
    const FrameLayout& status = fd ? kFrameLayouts[kFdPoseFrameIndex] : kFrameLayouts[4];
    for (const double x_m : {0.0, 1e6}) {
      const PoseFrames sent = encoder.encode(report_at(x_m));
      PoseReport received;
      decode_frame(status, sent.frames[fd ? 0 : 4].payload(), received);
      EXPECT_EQ(sent.saturated, x_m != 0.0);
      EXPECT_EQ(received.saturated, x_m != 0.0 ? 1 : 0);
    }
  }
}

TEST(PoseReport, YawOfHalfATurnIsPositive) {
  ndt::Fix fix = fix_at({0.0, 0.0, 0.0}, {});
  fix.at.pose.linear() << -1, 0.0, 0, -0.0, -1, 0, 0, 0, 1;  // atan2(-0, -1) is -pi
  EXPECT_NEAR(report_of(fix, drivers::TimeSource::sensor, true).yaw_rad, M_PI, 1e-12);
}

TEST(PoseReport, SigmasFollowTheHeading) {
  ndt::Fix fix = fix_at({0.0, 0.0, 0.0}, {.yaw_rad = M_PI / 2});
  fix.covariance.diagonal() << 0.01, 0.04, 0.09, 1e-4, 4e-4, 9e-4;
  const PoseReport report = report_of(fix, drivers::TimeSource::sensor, true);
  EXPECT_NEAR(report.sigma_along_m, 0.2, 1e-12);
  EXPECT_NEAR(report.sigma_cross_m, 0.1, 1e-12);
  EXPECT_NEAR(report.sigma_up_m, 0.3, 1e-12);
  EXPECT_NEAR(report.sigma_roll_rad, 0.02, 1e-12);
  EXPECT_NEAR(report.sigma_pitch_rad, 0.01, 1e-12);
  EXPECT_NEAR(report.sigma_yaw_rad, 0.03, 1e-12);
}

TEST(PoseReport, OfAPoseNotToBeUsedHasNoNumbersButItsStateAndTime) {
  ndt::Fix fix = fix_at({1, 2, 3}, {});
  fix.state = ndt::State::lost;
  const PoseReport report = report_of(fix, drivers::TimeSource::receive, false);
  for (const double value : {report.x_m, report.y_m, report.z_m, report.yaw_rad, report.speed_x_mps,
                             report.yaw_rate_radps, report.sigma_along_m, report.sigma_yaw_rad}) {
    EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_EQ(report.state, 2);
  EXPECT_EQ(report.time_source, 1);
  EXPECT_EQ(report.partial_sweep, 1);
  EXPECT_EQ(report.stamp_utc_ns, fix.at.stamp_utc_ns);
}

TEST(PoseReport, NamesTheWeakAxes) {
  ndt::Fix fix = fix_at({0.0, 0.0, 0.0}, {});
  EXPECT_EQ(report_of(fix, drivers::TimeSource::sensor, true).weak, 0);
  fix.match.weak.at[0].axis = ndt::Axis::longitudinal;
  fix.match.weak.at[1].axis = ndt::Axis::yaw;
  fix.match.weak.count = 2;
  const PoseReport report = report_of(fix, drivers::TimeSource::sensor, true);
  EXPECT_EQ(report.weak, 1);
  EXPECT_EQ(report.weak_axes, 0b100001);
}

}  // namespace
}  // namespace landfix::platform
