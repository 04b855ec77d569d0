#include "drivers/calibration_text.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace landfix::drivers {
namespace {

using testing::StrEq;

TEST(CalibrationText, TrimsBlanksAndLineEndsAtBothEndsOnly) {
  EXPECT_EQ(trimmed(" \t1, 2\r\n"), "1, 2");
  EXPECT_EQ(trimmed("1"), "1");
  EXPECT_EQ(trimmed(" \r\n"), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(CalibrationText, TakesFieldsOneAfterAnotherAndTheLastWhole) {
  std::string_view text = "a,,b";
  EXPECT_EQ(take_until(text, ','), "a");
  EXPECT_EQ(take_until(text, ','), "") << "between two separators";
  EXPECT_EQ(take_until(text, ','), "b") << "there is none any more";
  EXPECT_EQ(text, "");
  EXPECT_EQ(take_until(text, ','), "") << "of nothing, nothing";

  text = "a,";
  EXPECT_EQ(take_until(text, ','), "a");
  EXPECT_TRUE(text.empty());
}

TEST(CalibrationText, ReadsFiniteNumbersAndNothingElse) {
  EXPECT_EQ(to_number(" -1.5\r"), -1.5);
  EXPECT_EQ(to_number("+2.5e0"), 2.5);
  EXPECT_EQ(to_number("0"), 0.0);
  for (const char* const text :
       {"", " ", "+", "-", "1 2", "1,5", "1x", "x", "0x10", "+-1", "nan", "inf", "-inf", "1e999"}) {
    EXPECT_EQ(to_number(text), std::nullopt) << '"' << text << '"';
  }
}

TEST(CalibrationText, LeavesTheByteOrderMarkOutWhereThereIsOne) {
  const auto text_of = [](std::string_view bytes) { return to_text(std::as_bytes(std::span(bytes))); };
  EXPECT_EQ(text_of("\xEF\xBB\xBF"
                    "1,2"),
            "1,2");
  EXPECT_EQ(text_of("1,2"), "1,2");
  EXPECT_EQ(text_of("\xEF\xBB"), "\xEF\xBB") << "half a mark is none";
  EXPECT_EQ(text_of(""), "");
}

std::string error_of_index(double number, std::size_t first, std::size_t count) {
  return test::error_of([&] { return to_index(number, first, count, "channel", "unit.csv", 7); });
}

TEST(CalibrationText, CountsBeamsFromWhereTheFormatDoes) {
  EXPECT_EQ(to_index(0.0, 0, 64, "laser_id", "db.xml", 1), 0U);
  EXPECT_EQ(to_index(-0.0, 0, 64, "laser_id", "db.xml", 1), 0U);
  EXPECT_EQ(to_index(63.0, 0, 64, "laser_id", "db.xml", 1), 63U);
  EXPECT_EQ(to_index(1.0, 1, 40, "channel", "unit.csv", 1), 0U);
  EXPECT_EQ(to_index(40.0, 1, 40, "channel", "unit.csv", 1), 39U);
}

TEST(CalibrationText, RefusesWhatIsNoIndexAndSaysWhereItStands) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double number : {0.0, 41.0, 1.5, 40.5, -1.0, 1e300, kInfinity, -kInfinity, kNan}) {
    EXPECT_THAT(error_of_index(number, 1, 40),
                StrEq("unit.csv:7: channel is not one of 1 to 40: is the file another sensor's?"))
        << number;
  }
  EXPECT_NE(error_of_index(0.0, 0, 0), "no error") << "no beams, no index";
}

TEST(CalibrationText, RanksRingsByElevationAndKeepsTheOrderOfEquals) {
  std::vector<Beam> beams{{.elevation_deg = 2.0},
                          {.elevation_deg = -1.0},
                          {.elevation_deg = 2.0},
                          {.elevation_deg = -25.0},
                          {.elevation_deg = -1.0}};
  rank_rings(beams);
  std::vector<int> rings;
  for (const Beam& beam : beams) rings.push_back(beam.ring);
  EXPECT_THAT(rings, testing::ElementsAre(3, 1, 4, 0, 2));

  std::vector<Beam> none;
  rank_rings(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace landfix::drivers
