#include "ndt/dead_reckoning.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace landfix::ndt::test {
namespace {

TEST(DeadReckoning, GrowsAloneByHowMuchTimeHasPassed) {
  DeadReckoning at_once;
  DeadReckoning in_sweeps;
  at_once.hold(true);
  in_sweeps.hold(true);
  EXPECT_EQ(at_once.sigma_m(), 0.0);
  at_once.pass(2.0);
  for (int sweep = 0; sweep < 20; ++sweep) in_sweeps.pass(0.1);
  EXPECT_NEAR(in_sweeps.sigma_m(), at_once.sigma_m(), 1e-9);
  // 0.15 m/s of velocity, and white acceleration of 0.5 m/s a second.
  EXPECT_NEAR(at_once.sigma_m(), std::sqrt(0.15 * 0.15 * 4.0 + 0.25 * 8.0 / 3.0), 1e-9);
}

TEST(DeadReckoning, KnowsNoVelocityBeforeTwoMatches) {
  DeadReckoning reckoning;
  EXPECT_GE(reckoning.sigma_m(), 1.0);
  reckoning.hold(false);
  EXPECT_EQ(reckoning.sigma_m(), 0.0);
  reckoning.pass(0.1);
  EXPECT_GT(reckoning.sigma_m(), 1.0);
}

TEST(SweepDistortion, IsHalfOfWhatTheMotionSurprisesBy) {
  SweepDistortion distortion;
  const Twist surprise = (Twist() << 0.02, -0.01, 0.03, 0.001, -0.002, 0.0).finished();
  for (int sweep = 0; sweep < 500; ++sweep) distortion.observe(sweep % 2 == 0 ? surprise : Twist(-surprise));
  EXPECT_LT((distortion.covariance().diagonal() - 0.25 * surprise.cwiseAbs2()).norm(), 1e-9);
}

}  // namespace
}  // namespace landfix::ndt::test
