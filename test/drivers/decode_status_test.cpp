#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "drivers/decoder.hpp"

namespace landfix::drivers {
namespace {

TEST(DecodeStatus, EveryOneHasAMeaningOfItsOwn) {
  std::set<std::string_view> meanings;
  for (std::size_t i = 0; i < kDecodeStatusCount; ++i) {
    meanings.insert(to_string(static_cast<DecodeStatus>(i)));
  }
  EXPECT_EQ(meanings.size(), kDecodeStatusCount);
  const std::string_view unknown = to_string(static_cast<DecodeStatus>(kDecodeStatusCount));
  EXPECT_FALSE(meanings.contains(unknown)) << "kDecodeStatusCount counts them all";
}

TEST(DecodeStatus, AllButPointsAndTelemetryCountAsRejected) {
  StatusCounts counts{};
  EXPECT_EQ(rejected(counts), 0U);
  std::iota(counts.begin(), counts.end(), 1);
  counts[static_cast<std::size_t>(DecodeStatus::decoded)] = 1'000'000;
  counts[static_cast<std::size_t>(DecodeStatus::telemetry)] = 1'000'000;
  EXPECT_EQ(rejected(counts), 3U + 4U + 5U + 6U + 7U + 8U + 9U + 10U + 11U + 12U);
}

}  // namespace
}  // namespace landfix::drivers
