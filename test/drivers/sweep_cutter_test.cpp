#include "drivers/sweep_cutter.hpp"

#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::drivers {
namespace {

/// Indices of the azimuths before which it cuts.
std::vector<std::size_t> cuts(double cut_deg, const std::vector<int>& azimuths_centideg) {
  SweepCutter cutter(cut_deg);
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < azimuths_centideg.size(); ++i) {
    if (cutter.advance(static_cast<std::uint16_t>(azimuths_centideg[i]))) at.push_back(i);
  }
  return at;
}

using Cuts = std::vector<std::size_t>;

TEST(Turned, IsForwardThroughZeroToo) {
  EXPECT_EQ(turned_centideg(100, 130), 30);
  EXPECT_EQ(turned_centideg(35990, 10), 20);
  EXPECT_EQ(turned_centideg(10, 35990), 35980) << "a step back is nearly a turn forward";
  EXPECT_EQ(turned_centideg(35999, 35999), 0);
}

TEST(SweepCutter, CutsWhereTheAzimuthPassesTheCut) {
  EXPECT_EQ(cuts(0, {35900, 35940, 35980, 20, 60}), Cuts{3});
  EXPECT_EQ(cuts(180, {17900, 17999, 18000, 18040, 35990, 10}), Cuts{2});
  EXPECT_EQ(cuts(-90, {26990, 27000}), Cuts{1});
  EXPECT_EQ(cuts(359.999, {35990, 0}), Cuts{1});
  EXPECT_EQ(cuts(725, {480, 500}), Cuts{1});
}

TEST(SweepCutter, DoesNotCutAtTheFirstBlock) { EXPECT_EQ(cuts(0, {0, 20, 40}), Cuts{}); }

TEST(SweepCutter, IgnoresJitterAlsoAtTheCut) {
  EXPECT_EQ(cuts(0, {100, 90, 120, 110}), Cuts{});
  EXPECT_EQ(cuts(0, {35980, 5, 35995, 10, 35999, 15, 55}), Cuts{1});
  EXPECT_EQ(cuts(0, {35980, 35970, 5}), Cuts{2});
}

TEST(SweepCutter, ABlockAtTheSameAzimuthBelongsToTheSameSweep) {
  EXPECT_EQ(cuts(0, {35980, 0, 0, 40, 40}), Cuts{1});
}

TEST(SweepCutter, CutsWithARestrictedFieldOfView) {
  // 270 to 90 deg through the front; nothing is sent from 90 to 270.
  EXPECT_EQ(cuts(0, {27000, 35990, 10, 8990, 27010, 35980, 20, 8980, 27000}), (Cuts{2, 6}));
  // The cut lies in the dark sector: the jump over it cuts.
  EXPECT_EQ(cuts(180, {27000, 35990, 10, 8990, 27010, 35980, 20, 8980, 27000}), (Cuts{4, 8}));
  EXPECT_EQ(cuts(0, {12000, 18000, 23900, 12010, 18000, 23990, 12000}), (Cuts{3, 6}));
}

TEST(SweepCutter, CutsOnceWhenPacketsAreLostAcrossTheCut) {
  EXPECT_EQ(cuts(0, {30000, 5000, 10000}), Cuts{1});
}

TEST(SweepCutter, TellsPacketsThatTurnTooFar) {
  SweepCutter cutter(0.0);
  EXPECT_FALSE(cutter.advance(100));
  EXPECT_FALSE(cutter.cannot_be(std::array<std::uint16_t, 3>{140, 35990, 10}));
  EXPECT_TRUE(cutter.cannot_be(std::array<std::uint16_t, 4>{20000, 5000, 20000, 5000}));
  EXPECT_FALSE(cutter.advance(140)) << "asking has not moved it";
}

TEST(SweepCutter, HostileAzimuthsDoNotRunAway) {
  SweepCutter cutter(0.0);
  std::mt19937 random(3);
  std::uniform_int_distribution<int> any(0, 35999);
  int count = 0;
  for (int i = 0; i < 1'000'000; ++i)
    count += cutter.advance(static_cast<std::uint16_t>(any(random))) ? 1 : 0;
  // A quarter turn on average a step.
  EXPECT_NEAR(count, 250'000, 10'000);
  for (int i = 0; i < 1'000'000; ++i)
    static_cast<void>(cutter.advance(static_cast<std::uint16_t>(35999 - i % 36000)));
}

}  // namespace
}  // namespace landfix::drivers
