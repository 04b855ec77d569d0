#include "platform/trajectory.hpp"

#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/atomic_file.hpp"
#include "support/error_of.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

std::string error_of(std::string_view text) {
  return test::error_of([&] { return parse_tum(text, "a.tum"); });
}

std::int64_t stamp_of(std::string stamp) {
  return parse_tum(stamp + " 0 0 0 0 0 0 1", "a.tum").at(0).stamp_utc_ns;
}

TEST(Trajectory, StampsAreExactToTheNanosecond) {
  EXPECT_EQ(stamp_of("1700000000.123456789"), 1'700'000'000'123'456'789);
  EXPECT_EQ(stamp_of("1700000000"), 1'700'000'000'000'000'000);
  EXPECT_EQ(stamp_of("1700000000."), 1'700'000'000'000'000'000);
  EXPECT_EQ(stamp_of("0.1"), 100'000'000);
  EXPECT_EQ(stamp_of(".5"), 500'000'000);
  EXPECT_EQ(stamp_of("1.700000000123456789e+09"), 1'700'000'000'123'456'789);
  EXPECT_EQ(stamp_of("25e-1"), 2'500'000'000);
  EXPECT_EQ(stamp_of("1.0000000005"), 1'000'000'001);
  EXPECT_EQ(stamp_of("1.00000000049"), 1'000'000'000);
  EXPECT_EQ(stamp_of("1e-20"), 0);
  EXPECT_EQ(stamp_of("9223372036.854775806"), std::numeric_limits<std::int64_t>::max() - 1);
}

TEST(Trajectory, WrongStampsAreRefused) {
  for (const char* stamp :
       {"", "x", "1.2.3", "-1", "1e", "1e99", "1e-99", "nan", ".", "9223372037", "1 e3"}) {
    EXPECT_NE(error_of(std::string(stamp) + " 0 0 0 0 0 0 1"), "no error") << stamp;
  }
}

TEST(Trajectory, SurvivesTheRoundTripToTheByte) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  std::vector<StampedPose> poses;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const Eigen::Vector3d translation_m(1000 * uniform(random), 1000 * uniform(random), uniform(random));
    poses.push_back(
        {.stamp_utc_ns = 1'700'000'000'000'000'001 + i * 100'000'003,
         .pose = ndt::make_pose(translation_m, {uniform(random), 0.4 * uniform(random), uniform(random)})});
  }
  const std::vector<StampedPose> read = parse_tum(format_tum(poses), "a.tum");
  ASSERT_EQ(read.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(read[i].stamp_utc_ns, poses[i].stamp_utc_ns);
    EXPECT_LT((read[i].pose.translation() - poses[i].pose.translation()).norm(), 1e-6);
    EXPECT_LT(ndt::angle_between(read[i].pose, poses[i].pose), 4e-9);
  }
  EXPECT_EQ(format_tum(poses), format_tum(poses));
}

TEST(Trajectory, IsWrittenWithWLast) {
  const StampedPose pose{.stamp_utc_ns = 1'700'000'000'000'000'042,
                         .pose = ndt::make_pose({1.0, -2.0, 0.5}, {.yaw_rad = M_PI / 2})};
  EXPECT_EQ(
      format_tum({&pose, 1}),
      "# timestamp tx ty tz qx qy qz qw\n"
      "1700000000.000000042 1.000000 -2.000000 0.500000 0.000000000 0.000000000 0.707106781 0.707106781\n");
}

TEST(Trajectory, ReadsCommentsBlankLinesTabsAndForeignLineEnds) {
  const auto poses =
      parse_tum("# header\r\n\r\n1\t2 3  4 0 0 0 2 # not normalised\r\n   \n2 +2 3 4 0 0 1e0 0", "a.tum");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].pose.translation(), Eigen::Vector3d(2, 3, 4));
  EXPECT_LT((poses[0].pose.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(std::abs(ndt::to_roll_pitch_yaw(poses[1].pose.linear()).yaw_rad), M_PI, 1e-12);
  EXPECT_TRUE(parse_tum("", "a.tum").empty());
}

TEST(Trajectory, ErrorsSayWhichLineAndWhatIsWrong) {
  EXPECT_EQ(error_of("# c\n1 2 3\n"), "a.tum:2: 3 columns; expected 8: timestamp tx ty tz qx qy qz qw");
  EXPECT_THAT(error_of("1 0 0 0 0 0 0 1 0"), HasSubstr("a.tum:1: 9 columns"));
  EXPECT_EQ(error_of("1 0 0 y 0 0 0 1"), "a.tum:1: column 4: 'y' is not a finite number");
  EXPECT_THAT(error_of("1 0 nan 0 0 0 0 1"), HasSubstr("column 3: 'nan' is not a finite number"));
  EXPECT_THAT(error_of("1 inf 0 0 0 0 0 1"), HasSubstr("column 2"));
  EXPECT_THAT(error_of("1 0 0 0 0 0 0 0"), HasSubstr("quaternion"));
  EXPECT_THAT(error_of("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1"), HasSubstr("a.tum:2: the time is not later"));
  EXPECT_THAT(error_of("1e-2147483648 0 0 0 0 0 0 1"), HasSubstr("is not a time"));
  EXPECT_THAT(error_of("1 0 0 0 1e300 1e300 0 1"), HasSubstr("no error"));
}

TEST(Trajectory, FilesAreReadAndWritten) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "t.tum";
  const StampedPose pose{.stamp_utc_ns = 5};
  write_tum(path, {&pose, 1});
  EXPECT_EQ(read_tum(path).at(0).stamp_utc_ns, 5);
  EXPECT_THROW((void)read_tum(directory.path() / "absent.tum"), std::runtime_error);
}

TEST(Trajectory, InterpolatesBetweenNeighboursOnly) {
  const std::vector<StampedPose> poses{
      {.stamp_utc_ns = 100, .pose = ndt::make_pose({0, 0, 0}, {.yaw_rad = 3.0})},
      {.stamp_utc_ns = 300, .pose = ndt::make_pose({4, 2, 0}, {.yaw_rad = -3.0})}};
  const auto middle = interpolate(poses, 200);
  ASSERT_TRUE(middle);
  EXPECT_LT((middle->translation() - Eigen::Vector3d(2, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(std::abs(ndt::to_roll_pitch_yaw(middle->linear()).yaw_rad), M_PI, 1e-9);  // over the short way
  const auto quarter = interpolate(poses, 150);
  EXPECT_NEAR(ndt::to_roll_pitch_yaw(quarter->linear()).yaw_rad, 3.0 + 0.25 * (2 * M_PI - 6.0), 1e-9);
  EXPECT_TRUE(interpolate(poses, 100));
  EXPECT_TRUE(interpolate(poses, 300));
  EXPECT_FALSE(interpolate(poses, 99));
  EXPECT_FALSE(interpolate(poses, 301));
  EXPECT_FALSE(interpolate({}, 1));
}

}  // namespace
}  // namespace landfix::platform
