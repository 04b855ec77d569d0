#include "drivers/sweep.hpp"

#include <array>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

class SweepTest : public testing::Test {
 protected:
  SweepTest() { sweep_.begin(kStartNs, true, TimeSource::sensor); }

  std::array<Point, 4> storage_{};
  Sweep sweep_{storage_};
};

TEST_F(SweepTest, EndsAtItsLatestPointWhateverTheOrder) {
  sweep_.push({.time_s = 0.25F});
  sweep_.push({.time_s = 0.125F});
  EXPECT_EQ(sweep_.last_time_s(), 0.25F);
  EXPECT_EQ(sweep_.end_utc_ns(), kStartNs + 250'000'000);
  EXPECT_EQ(sweep_.points().size(), 2U);
}

TEST_F(SweepTest, TakesManyPointsThatWereWrittenInPlace) {
  sweep_.push({.time_s = 0.25F});
  ASSERT_EQ(sweep_.unused().size(), 3U);
  sweep_.unused()[0] = {.x = 5.0F, .time_s = 0.5F};
  sweep_.take(1, 0.5F);
  EXPECT_EQ(sweep_.points().size(), 2U);
  EXPECT_EQ(sweep_.points()[1].x, 5.0F);
  EXPECT_EQ(sweep_.last_time_s(), 0.5F);
  sweep_.take(0, 9.0F);
  EXPECT_EQ(sweep_.last_time_s(), 0.5F) << "of no points there is no latest time";
}

TEST_F(SweepTest, CountsWhatDoesNotFitAndIsPartialThen) {
  for (int i = 0; i < 4; ++i) sweep_.push({.time_s = 0.25F});
  EXPECT_TRUE(sweep_.complete());
  sweep_.push({.time_s = 0.5F});
  EXPECT_EQ(sweep_.overflowed(), 1U);
  EXPECT_EQ(sweep_.points().size(), 4U);
  EXPECT_EQ(sweep_.last_time_s(), 0.25F);
  EXPECT_FALSE(sweep_.complete());
}

TEST(Sweep, WithoutStorageKeepsNothing) {
  Sweep none;
  none.begin(kStartNs, true, TimeSource::sensor);
  none.push({});
  EXPECT_EQ(none.overflowed(), 1U);
  EXPECT_TRUE(none.points().empty());
}

TEST_F(SweepTest, BeginsEarlierWithoutMovingItsPointsInTime) {
  sweep_.push({.time_s = 0.25F});
  sweep_.begin_earlier(125'000'000);
  EXPECT_EQ(sweep_.start_utc_ns(), kStartNs - 125'000'000);
  EXPECT_EQ(sweep_.points()[0].time_s, 0.375F);
  EXPECT_EQ(sweep_.end_utc_ns(), kStartNs + 250'000'000);
}

TEST_F(SweepTest, WithoutPointsEndsWhereItBeginsAlsoWhenThatIsEarlier) {
  sweep_.begin_earlier(125'000'000);
  EXPECT_EQ(sweep_.end_utc_ns(), kStartNs - 125'000'000);
}

TEST_F(SweepTest, IsCompleteOnceEveryLostPacketIsBack) {
  sweep_.lose_packets(2);
  sweep_.recover_packet();
  EXPECT_FALSE(sweep_.complete());
  sweep_.recover_packet();
  EXPECT_TRUE(sweep_.complete());
  sweep_.recover_packet();
  EXPECT_EQ(sweep_.lost_packets(), 0U) << "not fewer than none";
  sweep_.mark_partial();
  EXPECT_FALSE(sweep_.complete());
}

TEST_F(SweepTest, ForgetsEverythingWhenItBeginsAnew) {
  for (int i = 0; i < 5; ++i) sweep_.push({.time_s = 0.25F});
  sweep_.lose_packets(3);
  sweep_.begin(kStartNs + 1, false, TimeSource::receive);
  EXPECT_TRUE(sweep_.points().empty());
  EXPECT_EQ(sweep_.overflowed(), 0U);
  EXPECT_EQ(sweep_.lost_packets(), 0U);
  EXPECT_EQ(sweep_.end_utc_ns(), kStartNs + 1);
  EXPECT_EQ(sweep_.time_source(), TimeSource::receive);
  EXPECT_FALSE(sweep_.complete()) << "it does not begin at the cut";
}

TEST(SweepPair, HandsOverTheCurrentSweepAndLetsTheOtherFill) {
  std::array<Point, 5> storage{};
  SweepPair sweeps(storage);
  ASSERT_EQ(sweeps.current().unused().size(), 2U) << "two halves, and a point too many";
  sweeps.current().begin(kStartNs, true, TimeSource::sensor);
  sweeps.current().push({.x = 1.0F});
  sweeps.cut();
  sweeps.current().begin(kStartNs + 1, true, TimeSource::sensor);
  sweeps.current().push({.x = 2.0F});
  sweeps.current().push({.x = 3.0F});
  ASSERT_EQ(sweeps.completed().points().size(), 1U);
  EXPECT_EQ(sweeps.completed().points()[0].x, 1.0F) << "not overwritten while the next one fills";
  EXPECT_EQ(sweeps.completed().start_utc_ns(), kStartNs);
}

}  // namespace
}  // namespace landfix::drivers
