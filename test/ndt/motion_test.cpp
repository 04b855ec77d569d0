#include "ndt/motion.hpp"

#include <random>

#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

TEST(Motion, VelocityLeadsFromOnePoseToTheOther) {
  const StampedPose from{1'000'000'000, make_pose({1.0, 2.0, 3.0}, {.roll_rad = 0.1, .yaw_rad = 2.0})};
  const StampedPose to{1'100'000'000, make_pose({1.7, 2.4, 3.1}, {.pitch_rad = 0.05, .yaw_rad = 2.1})};
  const Velocity velocity = velocity_between(from, to);
  EXPECT_LT((predict(from, velocity, to.stamp_utc_ns).matrix() - to.pose.matrix()).norm(), 1e-9);
  // Half the time leads half the way along the same screw.
  const Pose half = predict(from, velocity, 1'050'000'000);
  EXPECT_LT((half * (from.pose.inverse() * half).matrix() - to.pose.matrix()).norm(), 1e-9);
}

TEST(Motion, NoTimeIsNoVelocity) {
  const StampedPose here{5, Pose::Identity()};
  const StampedPose there{5, make_pose({1.0, 0.0, 0.0}, {})};
  EXPECT_EQ(velocity_between(here, there), Velocity::Zero());
  EXPECT_EQ(velocity_between({6, Pose::Identity()}, there), Velocity::Zero());
}

/// A vehicle that drives fast through a tight curve, a sensor on its roof.
Velocity fast_curve() {
  Velocity velocity;
  velocity << 14.0, 0.3, -0.2, 0.05, -0.1, 0.9;
  return velocity;
}
const Pose kSensorPose = make_pose({1.2, 0.1, 1.9}, {.roll_rad = 0.02, .pitch_rad = -0.1, .yaw_rad = 0.5});
constexpr std::int64_t kStartUtcNs = 1'700'000'000'000'000'000;

TEST(Deskew, BringsFixedPointsToWhereTheyAreSeenAtTheEnd) {
  // GIVEN points fixed in the world, and a sweep of 5 Hz that lasts half a turn too long
  const Velocity velocity = fast_curve();
  constexpr double kDuration_s = 0.3;
  const Pose at_end = make_pose({100.0, -50.0, 2.0}, {.yaw_rad = 1.0});
  Deskew deskew;
  deskew.begin(kStartUtcNs, velocity, kSensorPose);
  const Pose to_end = deskew.from_start(kStartUtcNs + 300'000'000);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  std::uniform_real_distribution<double> time(0.0, kDuration_s);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d world =
        at_end.translation() + Eigen::Vector3d(place(random), place(random), 0.1 * place(random));
    // WHEN each is seen from where the sensor was at its firing time
    const double time_s = time(random);
    const Pose sensor_then = at_end * pose_exp(velocity * (time_s - kDuration_s)) * kSensorPose;
    const Eigen::Vector3f seen = (sensor_then.inverse() * world).cast<float>();
    // THEN deskewing gives its place relative to the vehicle at the end of the sweep
    const Eigen::Vector3f expected = (at_end.inverse() * world).cast<float>();
    const Eigen::Vector3f at_start = deskew.to_start(
        {.x = seen.x(), .y = seen.y(), .z = seen.z(), .time_s = static_cast<float>(time_s)}, 0.0F);
    EXPECT_LT((to_end.cast<float>() * at_start - expected).norm(), 2e-4F);
  }
}

TEST(Deskew, IsNotMovedByASweepThatTurnsOutToHaveBegunEarlier) {
  Deskew deskew;
  deskew.begin(kStartUtcNs, fast_curve(), kSensorPose);
  const auto at = [&deskew](float time_s, float late_s) {
    return deskew.to_start({.x = 50.0F, .y = 20.0F, .z = 1.0F, .time_s = time_s}, late_s);
  };
  // A packet that was overtaken: its first firing is 1 ms before the start, those of others are later.
  EXPECT_LT((at(0.021F, -0.001F) - at(0.020F, 0.0F)).norm(), 1e-4F);
  const Pose then = pose_exp(fast_curve() * -0.001) * kSensorPose;
  EXPECT_LT((at(0.0F, -0.001F) - (then * Eigen::Vector3d(50.0, 20.0, 1.0)).cast<float>()).norm(), 2e-4F);
}

TEST(Deskew, OnlyPlacesTheSensorWhereNothingMovesOrNothingIsTimed) {
  const Pose sensor_pose = make_pose({1.0, 2.0, 3.0}, {.yaw_rad = 1.5707963267948966});
  Deskew deskew;
  deskew.begin(kStartUtcNs, Velocity::Zero(), sensor_pose);
  for (const float time_s : {0.0F, 0.05F, 10.0F}) {
    const Eigen::Vector3f point = deskew.to_start({.x = 1.0F, .time_s = time_s}, 0.0F);
    EXPECT_LT((point - Eigen::Vector3f(1.0F, 3.0F, 3.0F)).norm(), 1e-5F);
  }
  EXPECT_TRUE(deskew.from_start(kStartUtcNs + 100'000'000).isApprox(Pose::Identity()));
}

TEST(SteadyPart, DrivesSlipsAndTurns) {
  const Velocity velocity = (Velocity() << 10.0, 0.1, 0.2, 0.03, 0.04, 0.5).finished();
  EXPECT_EQ(steady_part(velocity), (Velocity() << 10.0, 0.1, 0.0, 0.0, 0.0, 0.5).finished());
}

}  // namespace
}  // namespace landfix::ndt
