#include "platform/evaluation.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

constexpr std::int64_t kStart_utc_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr double kDegree_rad = M_PI / 180.0;

/// 10 m/s along a bend that climbs, ten poses a second.
std::vector<StampedPose> drive(int poses = 51) {
  std::vector<StampedPose> result;
  for (int i = 0; i < poses; ++i) {
    const double t_s = 0.1 * i;
    const double yaw_rad = 0.2 * t_s;
    const Eigen::Vector3d position_m(50 * std::sin(yaw_rad), 50 * (1 - std::cos(yaw_rad)), 0.3 * t_s * t_s);
    result.push_back({.stamp_utc_ns = kStart_utc_ns + i * kPeriod_ns,
                      .pose = ndt::make_pose(position_m, {.roll_rad = 0.01 * t_s, .yaw_rad = yaw_rad})});
  }
  return result;
}

template <class Change>
std::vector<StampedPose> changed(std::vector<StampedPose> poses, Change change) {
  for (StampedPose& stamped : poses) stamped.pose = change(stamped.pose);
  return poses;
}

TEST(Evaluation, ATrajectoryIsItself) {
  const Evaluation result = evaluate(drive(), drive());
  EXPECT_EQ(result.pairs, 51U);
  EXPECT_EQ(result.unmatched, 0U);
  EXPECT_LT(result.ate_m.max, 1e-12);
  EXPECT_LT(result.ate_deg.max, 1e-6);
  EXPECT_LT(result.rpe_m.max, 1e-12);
  EXPECT_EQ(result.rpe_pairs, 42U);  // 41 over 1 s, and one over 0.9 s at the end
}

TEST(Evaluation, AConstantOffsetIsTheAbsoluteErrorAndNoRelativeOne) {
  const auto estimate = changed(
      drive(), [](const ndt::Pose& pose) { return ndt::Pose(Eigen::Translation3d(0.3, 0.0, -0.4) * pose); });
  const Evaluation result = evaluate(drive(), estimate);
  EXPECT_NEAR(result.ate_m.rmse, 0.5, 1e-12);
  EXPECT_NEAR(result.ate_m.mean, 0.5, 1e-12);
  EXPECT_NEAR(result.ate_m.median, 0.5, 1e-12);
  EXPECT_NEAR(result.ate_m.max, 0.5, 1e-12);
  EXPECT_NEAR(result.elevation_m.rmse, 0.4, 1e-12);
  EXPECT_NEAR(result.elevation_m.max, 0.4, 1e-12);
  EXPECT_LT(result.heading_deg.rmse, 1e-6);
  EXPECT_LT(result.rpe_m.rmse, 1e-12);
}

TEST(Evaluation, AConstantErrorOfHeadingIsFoundAcrossTheWrap) {
  // The reference's yaw crosses 180 deg, the estimate is 2 deg ahead.
  const ndt::Pose turned = ndt::make_pose({0, 0, 0}, {.yaw_rad = M_PI - 0.5});
  const auto reference = changed(drive(), [&](const ndt::Pose& pose) { return turned * pose; });
  const auto estimate = changed(reference, [](const ndt::Pose& pose) {
    return pose * ndt::make_pose({0, 0, 0}, {.yaw_rad = 2 * kDegree_rad});
  });
  const Evaluation result = evaluate(reference, estimate);
  EXPECT_NEAR(result.heading_deg.rmse, 2.0, 0.01);
  EXPECT_NEAR(result.heading_deg.max, 2.0, 0.01);
  EXPECT_NEAR(result.ate_deg.mean, 2.0, 1e-9);
  EXPECT_LT(result.ate_m.rmse, 1e-12);
}

TEST(Evaluation, RollAndPitchAreToldApart) {
  const auto tilted = [](double roll_deg, double pitch_deg) {
    return changed(drive(), [=](const ndt::Pose& pose) {
      return pose * ndt::make_pose({0, 0, 0}, {.roll_rad = roll_deg * kDegree_rad,
                                               .pitch_rad = pitch_deg * kDegree_rad});
    });
  };
  EXPECT_NEAR(evaluate(drive(), tilted(1, 0)).roll_deg.rmse, 1.0, 1e-9);
  EXPECT_LT(evaluate(drive(), tilted(1, 0)).pitch_deg.rmse, 1e-6);
  EXPECT_NEAR(evaluate(drive(), tilted(0, 1)).pitch_deg.rmse, 1.0, 1e-2);
}

TEST(Evaluation, StatisticsOfAKnownSeries) {
  // Errors 0, 1, 2, 3 m.
  auto estimate = drive(4);
  for (std::size_t i = 0; i < 4; ++i) estimate[i].pose.translation().x() += static_cast<double>(i);
  const Evaluation result = evaluate(drive(4), estimate);
  EXPECT_NEAR(result.ate_m.rmse, std::sqrt(14.0 / 4.0), 1e-12);
  EXPECT_NEAR(result.ate_m.mean, 1.5, 1e-12);
  EXPECT_NEAR(result.ate_m.median, 1.5, 1e-12);
  EXPECT_NEAR(result.ate_m.max, 3.0, 1e-12);
}

TEST(Evaluation, AligningTheFirstPoseUndoesARigidMotion) {
  const ndt::Pose moved = ndt::make_pose({100, -50, 3}, {0.1, -0.2, 2.5});
  const auto estimate = changed(drive(), [&](const ndt::Pose& pose) { return moved * pose; });
  EXPECT_GT(evaluate(drive(), estimate).ate_m.mean, 50.0);
  const Evaluation result = evaluate(drive(), estimate, {.alignment = Alignment::first});
  EXPECT_LT(result.ate_m.max, 1e-9);
  EXPECT_LT(result.ate_deg.max, 1e-6);
}

TEST(Evaluation, AligningAllPositionsUndoesARigidMotionDespiteABadFirstPose) {
  const ndt::Pose moved = ndt::make_pose({100, -50, 3}, {0.1, -0.2, 2.5});
  auto estimate = changed(drive(), [&](const ndt::Pose& pose) { return moved * pose; });
  EXPECT_LT(evaluate(drive(), estimate, {.alignment = Alignment::se3}).ate_m.max, 1e-9);
  EXPECT_LT(evaluate(drive(), estimate, {.alignment = Alignment::se3}).ate_deg.max, 1e-6);
  estimate.front().pose = estimate.front().pose * ndt::make_pose({0, 0, 0}, {.yaw_rad = 0.3});
  EXPECT_LT(evaluate(drive(), estimate, {.alignment = Alignment::se3}).ate_m.max, 1e-9);
  EXPECT_GT(evaluate(drive(), estimate, {.alignment = Alignment::first}).ate_m.max, 1.0);
}

TEST(Evaluation, AligningPositionsOnALineIsRefused) {
  std::vector<StampedPose> line = drive(20);
  for (std::size_t i = 0; i < line.size(); ++i) {
    line[i].pose = ndt::make_pose({static_cast<double>(i), 0.0, 0.0}, {});
  }
  EXPECT_THROW((void)evaluate(line, line, {.alignment = Alignment::se3}), std::runtime_error);
  EXPECT_THROW((void)evaluate(line, std::span(line).first(1), {.alignment = Alignment::se3}),
               std::runtime_error);
  EXPECT_LT(evaluate(line, line, {.alignment = Alignment::first}).ate_m.max, 1e-12);
}

TEST(Evaluation, ADriftOfScaleIsTheRelativeErrorOverItsInterval) {
  std::vector<StampedPose> reference = drive(51);
  std::vector<StampedPose> estimate = reference;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto x_m = static_cast<double>(i);  // 10 m/s, straight
    reference[i].pose = ndt::make_pose({x_m, 0.0, 0.0}, {});
    estimate[i].pose = ndt::make_pose({1.01 * x_m, 0.0, 0.0}, {});
  }
  const std::span<const StampedPose> all(estimate);
  EXPECT_NEAR(evaluate(reference, all, {.delta_ns = 100'000'000}).rpe_m.rmse, 0.01, 1e-12);
  EXPECT_NEAR(evaluate(reference, all).rpe_m.max, 0.10, 1e-12);
  EXPECT_NEAR(evaluate(reference, all, {.delta_ns = 4'000'000'000}).rpe_m.max, 0.40, 1e-12);
  EXPECT_TRUE(std::isnan(evaluate(reference, all, {.delta_ns = 20'000'000'000}).rpe_m.rmse));
}

TEST(Evaluation, TheReferenceIsInterpolatedAndNeverExtrapolated) {
  std::vector<StampedPose> reference = drive(3);
  for (std::size_t i = 0; i < 3; ++i) reference[i].pose = ndt::make_pose({static_cast<double>(i), 0, 0}, {});
  std::vector<StampedPose> estimate{
      {.stamp_utc_ns = kStart_utc_ns - 1},
      {.stamp_utc_ns = kStart_utc_ns + kPeriod_ns / 2, .pose = ndt::make_pose({0.5, 0, 0}, {})},
      {.stamp_utc_ns = kStart_utc_ns + 2 * kPeriod_ns + 1}};
  const Evaluation result = evaluate(reference, estimate);
  EXPECT_EQ(result.pairs, 1U);
  EXPECT_EQ(result.unmatched, 2U);
  EXPECT_LT(result.ate_m.max, 1e-12);
  EXPECT_EQ(result.rpe_pairs, 0U);
}

TEST(Evaluation, NoPairsIsAnError) {
  auto later = drive(5);
  for (StampedPose& pose : later) pose.stamp_utc_ns += 1'000'000'000'000;
  EXPECT_THROW((void)evaluate(drive(5), later), std::runtime_error);
  EXPECT_THROW((void)evaluate(drive(5), {}), std::runtime_error);
  EXPECT_THROW((void)evaluate({}, drive(5)), std::runtime_error);
}

}  // namespace
}  // namespace landfix::platform
