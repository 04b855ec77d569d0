#include "tools/simulator/vehicle_motion.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/test_route.hpp"
#include "tools/simulator/path.hpp"

namespace landfix::tools::simulator {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

/// Down, level, and up a slope, with two turns.
class VehicleMotionTest : public ::testing::Test {
 protected:
  const Route route_ = test::route_of(
      "[road]\n[scenery]\n[[segment]]\nlength_m = 80\ngrade = -0.08\nspeed_kmh = 30\n"
      "[[segment]]\nlength_m = 50\nturn_deg = 70\nspeed_kmh = 40\n"
      "[[segment]]\nlength_m = 80\ngrade = 0.08\nspeed_kmh = 36\n"
      "[[segment]]\nlength_m = 50\nturn_deg = -60\nspeed_kmh = 20\n");
  const Path path_{route_};
  const Ground ground_{path_, route_, {}, 3};
  const VehicleMotion vehicle_{route_, ground_};
};

TEST_F(VehicleMotionTest, StandsAtTheStartAndAtTheEndOfTheRoute) {
  EXPECT_NEAR(vehicle_.station_at(0.0), 0.0, 1e-9);
  EXPECT_NEAR(vehicle_.station_at(0.5), 0.0, 1e-6);
  EXPECT_NEAR(vehicle_.station_at(vehicle_.duration_s()), 260.0, 1e-9);
  EXPECT_NEAR(vehicle_.speed_at(vehicle_.duration_s()), 0.0, 1e-9);
  EXPECT_LT((vehicle_.pose_at(-5.0).matrix() - vehicle_.pose_at(0.0).matrix()).norm(), 1e-12);
  EXPECT_LT((vehicle_.pose_at(1e6).matrix() - vehicle_.pose_at(vehicle_.duration_s()).matrix()).norm(),
            1e-12);
}

TEST_F(VehicleMotionTest, TheDerivativeOfThePoseIsTheSpeedAlongTheNose) {
  constexpr double kStep_s = 1e-3;
  for (double t = 2.0; t < vehicle_.duration_s() - 2.0; t += 0.01) {
    const ndt::Pose pose = vehicle_.pose_at(t);
    const Eigen::Vector3d velocity_mps =
        (vehicle_.pose_at(t + kStep_s).translation() - vehicle_.pose_at(t - kStep_s).translation()) /
        (2.0 * kStep_s);
    const double speed_mps = vehicle_.speed_at(t);
    ASSERT_NEAR(velocity_mps.norm(), speed_mps, 0.01 * speed_mps + 0.01) << t;
    const double course_rad = std::atan2(velocity_mps.y(), velocity_mps.x());
    const double yaw_rad = ndt::to_roll_pitch_yaw(pose.linear()).yaw_rad;
    ASSERT_LT(std::abs(std::remainder(course_rad - yaw_rad, 2.0 * std::numbers::pi)), 0.2 * kDegree_rad) << t;
  }
}

TEST_F(VehicleMotionTest, AcceleratesWithinWhatPassengersLike) {
  constexpr double kStep_s = 0.02;
  for (double t = 0.0; t < vehicle_.duration_s(); t += kStep_s) {
    const double acceleration_mps2 =
        (vehicle_.speed_at(t + kStep_s) - vehicle_.speed_at(t - kStep_s)) / (2.0 * kStep_s);
    ASSERT_LT(std::abs(acceleration_mps2), 1.55) << t;
    const double curvature_1pm = path_.at(vehicle_.station_at(t)).curvature_1pm;
    ASSERT_LT(vehicle_.speed_at(t) * vehicle_.speed_at(t) * std::abs(curvature_1pm), 2.2) << t;
  }
}

TEST_F(VehicleMotionTest, MovesWithoutJumps) {
  constexpr double kStep_s = 1e-3;
  ndt::Twist last = ndt::Twist::Zero();
  for (double t = -0.1; t < vehicle_.duration_s() + 0.1; t += kStep_s) {
    const ndt::Twist rate =
        ndt::pose_log(vehicle_.pose_at(t).inverse() * vehicle_.pose_at(t + kStep_s)) / kStep_s;
    ASSERT_LT((rate - last).head<3>().norm(), 0.02) << t;  // m/s within a millisecond
    ASSERT_LT((rate - last).tail<3>().norm(), 0.02) << t;  // rad/s
    last = rate;
  }
}

TEST_F(VehicleMotionTest, TheNoseIsUpUphillAndDownDownhill) {
  const auto pitch_at_station = [this](double station_m) {
    double t = 0.0;
    while (vehicle_.station_at(t) < station_m) t += 0.01;
    return ndt::to_roll_pitch_yaw(vehicle_.pose_at(t).linear()).pitch_rad;
  };
  EXPECT_NEAR(pitch_at_station(45.0), std::atan(0.08), 1.0 * kDegree_rad);    // downhill: positive
  EXPECT_NEAR(pitch_at_station(170.0), -std::atan(0.08), 1.0 * kDegree_rad);  // uphill: negative
}

TEST_F(VehicleMotionTest, StaysOnTheGround) {
  for (double t = 0.0; t < vehicle_.duration_s(); t += 0.25) {
    const Eigen::Vector3d position_m = vehicle_.pose_at(t).translation();
    ASSERT_NEAR(position_m.z(), ground_.height_m(Eigen::Vector2d(position_m.head<2>())), 0.01) << t;
  }
}

TEST_F(VehicleMotionTest, TheRoadFallsToItsEdgesSoThatTheVehicleLeansOutwards) {
  // In the right lane the left wheels stand nearer to the crown: higher, which is a positive roll.
  const double roll_rad = ndt::to_roll_pitch_yaw(vehicle_.pose_at(0.0).linear()).roll_rad;
  EXPECT_NEAR(roll_rad, std::atan(0.02), 0.4 * kDegree_rad);
}

}  // namespace
}  // namespace landfix::tools::simulator
