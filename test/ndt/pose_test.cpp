#include "ndt/pose.hpp"

#include <random>

#include <gtest/gtest.h>

namespace landfix::ndt {
namespace {

Twist random_twist(std::mt19937_64& random, double rotation_rad) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = uniform(random);
  twist.tail<3>() *= rotation_rad / twist.tail<3>().norm();
  return twist;
}

TEST(Pose, LogUndoesExpAtEveryAngle) {
  std::mt19937_64 random(1);
  for (const double angle_rad : {1e-12, 1e-8, 1e-5, 0.9999e-4, 1.0001e-4, 1e-3, 0.1, 1.0, 3.0, 3.1415}) {
    const Twist twist = random_twist(random, angle_rad);
    EXPECT_LT((pose_log(pose_exp(twist)) - twist).norm(), 1e-9) << angle_rad;
  }
}

TEST(Pose, ExpIsTheLimitOfManySmallSteps) {
  std::mt19937_64 random(2);
  const Twist twist = random_twist(random, 1.2);
  Pose stepped = Pose::Identity();
  constexpr int kSteps = 1 << 20;
  Twist step = twist / kSteps;
  Pose small = Pose::Identity();
  small.linear() += skew(step.tail<3>());
  small.translation() = step.head<3>();
  for (int i = 0; i < 20; ++i) small = small * small;
  stepped = small;
  EXPECT_LT((stepped.matrix() - pose_exp(twist).matrix()).norm(), 1e-5);
}

TEST(Pose, AnglesAreThoseOfTheDesign) {
  // Positive pitch is nose down: the forward axis gains a negative z.
  EXPECT_LT(to_rotation({.pitch_rad = 0.1}).col(0).z(), 0.0);
  // Positive yaw turns left, positive roll lifts the left side.
  EXPECT_GT(to_rotation({.yaw_rad = 0.1}).col(0).y(), 0.0);
  EXPECT_GT(to_rotation({.roll_rad = 0.1}).col(1).z(), 0.0);
}

TEST(Pose, AnglesSurviveTheRoundTrip) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> turn(-3.14, 3.14);
  std::uniform_real_distribution<double> half_turn(-1.57, 1.57);
  for (int i = 0; i < 1000; ++i) {
    const RollPitchYaw in{turn(random), half_turn(random), turn(random)};
    const RollPitchYaw out = to_roll_pitch_yaw(to_rotation(in));
    EXPECT_NEAR(out.roll_rad, in.roll_rad, 1e-9);
    EXPECT_NEAR(out.pitch_rad, in.pitch_rad, 1e-9);
    EXPECT_NEAR(out.yaw_rad, in.yaw_rad, 1e-9);
  }
}

TEST(Pose, AnglesOfAVerticalNoseStillGiveTheSameRotation) {
  for (const double pitch_rad : {M_PI / 2, -M_PI / 2}) {
    const Eigen::Matrix3d rotation = to_rotation({.roll_rad = 0.3, .pitch_rad = pitch_rad, .yaw_rad = 1.1});
    EXPECT_LT((to_rotation(to_roll_pitch_yaw(rotation)) - rotation).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace landfix::ndt
