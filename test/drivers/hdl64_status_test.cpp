#include "drivers/velodyne/hdl64_status.hpp"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "support/hdl64_status_stream.hpp"

namespace landfix::drivers::velodyne {
namespace {

using test::sent_set;
using Status = test::Hdl64Status;

/// How many whole sets there are in what was sent.
int sets_in(Hdl64SetCollector& collector, const std::vector<Status>& sent, Hdl64Calibration& calibration) {
  int sets = 0;
  for (const Status& status : sent) sets += collector.take(status.type, status.value, calibration) ? 1 : 0;
  return sets;
}
int sets_in(const std::vector<Status>& sent) {
  Hdl64SetCollector collector(Hdl64Checksum::constant);
  Hdl64Calibration calibration;
  return sets_in(collector, sent, calibration);
}

std::vector<Status> twice(std::vector<Status> sent) {
  const auto second = sent;
  sent.insert(sent.end(), second.begin(), second.end());
  return sent;
}

TEST(Hdl64SetCollector, ReadsEveryFieldOfASet) {
  const auto sent = sent_set();
  ASSERT_EQ(sent.size(), 4160U);
  Hdl64SetCollector collector(Hdl64Checksum::constant);
  Hdl64Calibration calibration;
  EXPECT_EQ(sets_in(collector, sent, calibration), 1);
  EXPECT_TRUE(calibration.intensity_is_corrected);
  EXPECT_DOUBLE_EQ(calibration.lasers[63].elevation_deg, 2.05);
  EXPECT_DOUBLE_EQ(calibration.lasers[0].elevation_deg, -20.0);
  EXPECT_DOUBLE_EQ(calibration.lasers[5].range_m, 1.4);
  EXPECT_DOUBLE_EQ(calibration.lasers[5].range_x_m, 1.4) << "no two-point values: the far one does";
  EXPECT_DOUBLE_EQ(calibration.lasers[5].focal_slope, 1.5);
  EXPECT_EQ(calibration.lasers[5].max_intensity, 255);
}

TEST(Hdl64SetCollector, FindsTheSetFromAnyPacketOn) {
  for (const std::size_t first : {1U, 9U, 10U, 15U, 16U, 2000U, 4159U}) {
    auto sent = twice(sent_set());
    sent.erase(sent.begin(), sent.begin() + static_cast<std::ptrdiff_t>(first));
    const bool lacks_letters_alone = first <= 9;
    EXPECT_EQ(sets_in(sent), lacks_letters_alone ? 2 : 1) << first;
  }
}

TEST(Hdl64SetCollector, DropsASetThatLostAPacketOrCycles) {
  for (const std::ptrdiff_t at : {9, 15, 100, 1000, 2009, 4159}) {
    auto sent = twice(sent_set());
    sent.erase(sent.begin() + at);
    const bool held_a_letter = at % 16 < 9;
    EXPECT_EQ(sets_in(sent), held_a_letter ? 2 : 1) << at;
  }
  for (const std::ptrdiff_t cycles : {1, 2, 4, 8}) {
    auto sent = twice(sent_set());
    sent.erase(sent.begin() + 300, sent.begin() + 300 + 16 * cycles);
    EXPECT_EQ(sets_in(sent), 1) << cycles << " cycles: the types go on as if nothing were missing";
  }
}

TEST(Hdl64SetCollector, IsNotDisturbedByPacketsThatComeTwice) {
  auto sent = sent_set();
  for (const std::ptrdiff_t at : {3000, 2009, 10})
    sent.insert(sent.begin() + at, sent[static_cast<std::size_t>(at)]);
  EXPECT_EQ(sets_in(sent), 1);
}

TEST(Hdl64SetCollector, RefusesASetThatDoesNotCheck) {
  const auto with = [](std::size_t byte, std::uint8_t value) {
    auto sent = sent_set();
    sent[byte / 7 * 16 + 9 + byte % 7].value = value;
    return sets_in(sent);
  };
  EXPECT_EQ(with(1810, 99), 1) << "an address";
  EXPECT_EQ(with(1818, 0x1D), 0) << "checksum";
  EXPECT_EQ(with(7 + 28 * 63, 62), 0) << "number of a laser";
  EXPECT_EQ(with(7 + 20, 0), 1);
  EXPECT_EQ(with(7 + 19, 1), 1);
  EXPECT_EQ(with(7 + 2, 0x7F), 0) << "an elevation of 326 deg";
  // The S3's checksum is another.
  Hdl64SetCollector s3(Hdl64Checksum::crc16);
  Hdl64Calibration calibration;
  EXPECT_EQ(sets_in(s3, sent_set(), calibration), 0);
  EXPECT_EQ(calibration, Hdl64Calibration{});
}

std::optional<std::int64_t> take_cycle(Hdl64Calendar& calendar, const std::array<int, 6>& fields, char gps) {
  constexpr std::string_view kFields = "HMSDNY";
  for (std::size_t i = 0; i < kFields.size(); ++i) {
    EXPECT_EQ(calendar.take(static_cast<std::uint8_t>(kFields[i]), static_cast<std::uint8_t>(fields[i])),
              std::nullopt);
  }
  return calendar.take('G', static_cast<std::uint8_t>(gps));
}

TEST(Hdl64Calendar, SaysTheTimeOnceTwoCyclesAgree) {
  Hdl64Calendar calendar;
  EXPECT_EQ(take_cycle(calendar, {8, 15, 0, 4, 5, 26}, 'A'), std::nullopt);
  EXPECT_EQ(take_cycle(calendar, {8, 15, 0, 4, 5, 26}, 'A'), 1'777'882'500);
  EXPECT_EQ(take_cycle(calendar, {8, 15, 1, 4, 5, 26}, 'A'), 1'777'882'501);
  EXPECT_EQ(take_cycle(calendar, {9, 15, 1, 4, 5, 26}, 'A'), std::nullopt) << "damaged";
  EXPECT_EQ(take_cycle(calendar, {8, 15, 1, 4, 5, 26}, 'A'), std::nullopt);
  EXPECT_EQ(take_cycle(calendar, {8, 15, 1, 4, 5, 26}, 'A'), 1'777'882'501);
}

TEST(Hdl64Calendar, IsSilentWithoutSatellitesOrADate) {
  for (const char gps : {'V', 'P', '\0'}) {
    Hdl64Calendar calendar;
    for (int i = 0; i < 4; ++i) EXPECT_EQ(take_cycle(calendar, {8, 15, 0, 4, 5, 26}, gps), std::nullopt);
  }
  Hdl64Calendar calendar;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(take_cycle(calendar, {8, 15, 0, 30, 2, 26}, 'A'), std::nullopt);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(calendar.take('G', 'A'), std::nullopt) << "fields are missing";
}

}  // namespace
}  // namespace landfix::drivers::velodyne
