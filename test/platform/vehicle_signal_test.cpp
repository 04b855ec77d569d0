#include "platform/vehicle_signal.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

CanFrame frame_of(std::vector<int> bytes) {
  CanFrame frame{.id = 0x123, .length = static_cast<std::uint8_t>(bytes.size()), .data = {}};
  for (std::size_t i = 0; i < bytes.size(); ++i) frame.data[i] = static_cast<std::byte>(bytes[i]);
  return frame;
}

VehicleSignal signal_at(RawField field) {
  return {.role = VehicleRole::speed, .id = 0x123, .field = field, .low = -1e9, .high = 1e9};
}

TEST(VehicleSignal, ReadsLittleEndianAtOddBits) {
  // 14 bits from bit 9 on, as Hyundai's wheels: 0x1234 << 9.
  const CanFrame frame = frame_of({0, 0x68, 0x24, 0});
  EXPECT_EQ(read_raw(frame.payload(), {.start = 9, .length = 14}), 0x1234U);
}

TEST(VehicleSignal, ReadsBigEndianAtOddBits) {
  // 15 bits from bit 6 of byte 0 on, as Toyota's wheels.
  const CanFrame frame = frame_of({0x9A, 0x6F, 0xFF});
  EXPECT_EQ(read_raw(frame.payload(), {.start = 6, .length = 15, .motorola = true}), 0x1A6FU);
  EXPECT_EQ(read_raw(frame.payload(), {.start = 7, .length = 16, .motorola = true}), 0x9A6FU);
  EXPECT_EQ(read_raw(frame.payload(), {.start = 3, .length = 8, .motorola = true}), 0xA6U);
}

TEST(VehicleSignal, BothOrdersAgreeWithPlainArithmeticWhereverTheBitsAre) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    CanFrame frame{.id = 0x123, .length = 8, .data = {}};
    std::uint64_t little = 0;
    std::uint64_t big = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) {
      frame.data[byte] = static_cast<std::byte>(random());
      little |= std::to_integer<std::uint64_t>(frame.data[byte]) << 8 * byte;
      big |= std::to_integer<std::uint64_t>(frame.data[byte]) << 8 * (7 - byte);
    }
    const auto length = static_cast<std::uint8_t>(1 + random() % 64);
    const auto first = static_cast<unsigned>(random() % (65U - length));  // in reading order
    const std::uint64_t mask = ~std::uint64_t{0} >> (64 - length);
    EXPECT_EQ(read_raw(frame.payload(), {.start = static_cast<std::uint16_t>(first), .length = length}),
              little >> first & mask);
    const auto motorola_start = static_cast<std::uint16_t>(first ^ 7U);
    const RawField motorola{.start = motorola_start, .length = length, .motorola = true};
    EXPECT_EQ(read_raw(frame.payload(), motorola), big >> (64U - first - length) & mask);
    EXPECT_LE(bytes_of(motorola), 8U);
  }
}

TEST(VehicleSignal, AppliesSignScaleAndOffset) {
  VehicleSignal signal = signal_at({.start = 7, .length = 12, .motorola = true, .is_signed = true});
  signal.scale = -0.0014;
  signal.offset = 2.86;
  EXPECT_NEAR(value_of(signal, frame_of({0xFF, 0xE0})).value(), 2.86 + 2 * 0.0014, 1e-12);
  VehicleSignal magnitude = signal_at({.start = 0, .length = 14});  // VW's yaw rate
  magnitude.sign_bit = 23;
  EXPECT_EQ(value_of(magnitude, frame_of({5, 0, 0x80})), -5.0);
  EXPECT_EQ(value_of(magnitude, frame_of({5, 0, 0x7F})), 5.0);
}

TEST(VehicleSignal, GivesNothingThatIsNotValid) {
  VehicleSignal signal = signal_at({.start = 0, .length = 8});
  signal.valid_bit = 8;
  signal.invalid_raw = {0xFE, 0xFF};
  signal.invalid_count = 2;
  signal.high = 200.0;
  EXPECT_EQ(value_of(signal, frame_of({100, 1})), 100.0);
  EXPECT_FALSE(value_of(signal, frame_of({100, 0})));
  EXPECT_FALSE(value_of(signal, frame_of({0xFE, 1})));
  EXPECT_FALSE(value_of(signal, frame_of({0xFF, 1})));
  EXPECT_FALSE(value_of(signal, frame_of({201, 1}))) << "beyond its limit";
  EXPECT_FALSE(value_of(signal, frame_of({100}))) << "no validity bit in the frame";
  signal.valid_value = false;
  EXPECT_EQ(value_of(signal, frame_of({100, 0})), 100.0);
  EXPECT_FALSE(value_of(signal_at({.start = 0, .length = 9}), frame_of({100}))) << "too short";
}

}  // namespace
}  // namespace landfix::platform
