#include "platform/can_signal.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Signal kX{"X", &PoseReport::x_m, signed_at(16, 24), 1e-3};
constexpr Signal kSigma{"SIGMA", &PoseReport::sigma_along_m, unsigned_at(20, 12), 1e-3};
constexpr Signal kStamp{"STAMP", &PoseReport::stamp_utc_ns, unsigned_at(16, 48), 1e-5};
constexpr Signal kStampNs{"STAMP_NS", &PoseReport::stamp_utc_ns, unsigned_at(24, 64), 1e-9};

RawValue encoded(const Signal& signal, double value) {
  PoseReport report;
  report.*std::get<double PoseReport::*>(signal.field) = value;
  return encode_signal(signal, report);
}

double sent(const Signal& signal, double value) {
  PoseReport report;
  decode_signal(signal, encoded(signal, value).raw, report);
  return report.*std::get<double PoseReport::*>(signal.field);
}

std::int64_t sent_time(const Signal& signal, std::int64_t stamp_utc_ns) {
  PoseReport report;
  report.stamp_utc_ns = stamp_utc_ns;
  const RawValue value = encode_signal(signal, report);
  decode_signal(signal, value.raw, report);
  return report.stamp_utc_ns;
}

TEST(CanSignal, RoundsHalfToEven) {
  const Signal two{"TWO", &PoseReport::x_m, signed_at(16, 16), 2.0};
  EXPECT_EQ(sent(two, 1.0), 0.0);
  EXPECT_EQ(sent(two, 3.0), 4.0);
  EXPECT_EQ(sent(two, 5.0), 4.0);
  EXPECT_EQ(sent(two, -1.0), 0.0);
  EXPECT_EQ(sent(two, -3.0), -4.0);
}

TEST(CanSignal, ClampsAndNeverWraps) {
  for (const double beyond : {9000.0, 8388.608, 1e300, kInfinity}) {
    EXPECT_NEAR(sent(kX, beyond), 8388.607, 1e-9);
    EXPECT_NEAR(sent(kX, -beyond), -8388.607, 1e-9);
    EXPECT_TRUE(encoded(kX, beyond).saturated);
    EXPECT_TRUE(encoded(kX, -beyond).saturated);
  }
  EXPECT_FALSE(encoded(kX, 8388.607).saturated);
  EXPECT_FALSE(encoded(kX, -8388.607).saturated);
  EXPECT_NEAR(sent(kSigma, 100.0), 4.094, 1e-12);
  EXPECT_EQ(sent(kSigma, -1.0), 0.0);
  EXPECT_TRUE(encoded(kSigma, -1.0).saturated);
}

TEST(CanSignal, NotAvailableIsAValueOfItsOwn) {
  EXPECT_EQ(encoded(kX, kNan).raw, 0x800000U);
  EXPECT_EQ(encoded(kSigma, kNan).raw, 0xFFFU);
  for (const Signal& signal : {kX, kSigma}) {
    EXPECT_TRUE(std::isnan(sent(signal, kNan)));
    EXPECT_FALSE(encoded(signal, kNan).saturated);
  }
  for (const Signal& signal : {kStamp, kStampNs}) {
    EXPECT_EQ(sent_time(signal, PoseReport::kNoTime), PoseReport::kNoTime);
  }
}

TEST(CanSignal, TimesRoundHalfToEvenAndKeepEveryNanosecondWhereTheyCan) {
  EXPECT_EQ(sent_time(kStamp, 1'700'000'000'123'456'789), 1'700'000'000'123'460'000);
  EXPECT_EQ(sent_time(kStamp, 25'000), 20'000);
  EXPECT_EQ(sent_time(kStamp, 35'000), 40'000);
  EXPECT_EQ(sent_time(kStamp, 0), 0);
  for (const std::int64_t stamp :
       {std::int64_t{0}, std::int64_t{1'700'000'000'123'456'789}, std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(sent_time(kStampNs, stamp), stamp);
  }
}

TEST(CanSignal, ATimeThatNoClockOfOursCanShowIsNotAvailable) {
  PoseReport report;
  decode_signal(kStampNs, std::uint64_t{1} << 63, report);
  EXPECT_EQ(report.stamp_utc_ns, PoseReport::kNoTime);
}

TEST(CanSignal, ATimeBeyondItsBitsIsTheLatest) {
  PoseReport report;
  report.stamp_utc_ns = 3'000'000'000'000'000'000;
  const RawValue value = encode_signal(kStamp, report);
  EXPECT_TRUE(value.saturated);
  EXPECT_EQ(value.raw, (std::uint64_t{1} << 48) - 2);
}

TEST(CanSignal, ACodeHasNoValueThatIsNone) {
  const Signal state{"STATE", &PoseReport::state, unsigned_at(16, 4)};
  PoseReport report;
  report.state = 15;
  EXPECT_EQ(encode_signal(state, report).raw, 15U);
  EXPECT_FALSE(encode_signal(state, report).saturated);
  report.state = 16;
  EXPECT_EQ(encode_signal(state, report).raw, 15U);
  EXPECT_TRUE(encode_signal(state, report).saturated);
}

TEST(CanSignal, BitsLieWhereTheyShouldAndNowhereElse) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20000; ++round) {
    const auto length = static_cast<std::uint8_t>(1 + random() % 64);
    const auto start = static_cast<std::uint16_t>(random() % (512 - length + 1U));
    std::array<std::byte, 64> before{};
    for (std::byte& byte : before) byte = static_cast<std::byte>(random() & 0xFF);
    const Bits bits = unsigned_at(start, length);
    const std::uint64_t value = random();
    auto after = before;
    put_bits(after, bits, value);
    EXPECT_EQ(get_bits(after, bits), value & bits.mask());
    for (std::size_t i = 0; i < 512; ++i) {
      const auto bit = [&](const auto& frame) {
        return std::to_integer<unsigned>(frame[i / 8]) >> i % 8 & 1U;
      };
      const bool is_inside = i >= start && i < std::size_t{start} + length;
      ASSERT_EQ(bit(after), is_inside ? (value >> (i - start) & 1U) : bit(before)) << i;
    }
  }
}

TEST(CanSignal, BitsBeyondTheFrameAreNotTouched) {
  std::array<std::byte, 2> frame{};
  put_bits(frame, unsigned_at(12, 16), 0xFFFF);
  EXPECT_EQ(frame[1], std::byte{0xF0});
  EXPECT_EQ(get_bits(frame, unsigned_at(12, 16)), 0xFU);
}

}  // namespace
}  // namespace landfix::platform
