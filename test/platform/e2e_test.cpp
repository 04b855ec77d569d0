#include "platform/e2e.hpp"

#include <array>
#include <random>

#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

using Frame = std::array<std::byte, 8>;

Frame protected_frame(std::uint16_t data_id, std::uint8_t counter, Frame frame = {}) {
  e2e_protect(frame, data_id, counter);
  return frame;
}

TEST(E2e, GivesTheVectorsOfProfile11C) {
  // Data id 0x0123, eight zero bytes, three frames in a row.
  EXPECT_EQ(protected_frame(0x0123, 0), (Frame{std::byte{0x2A}, std::byte{0x10}}));
  EXPECT_EQ(protected_frame(0x0123, 1), (Frame{std::byte{0x77}, std::byte{0x11}}));
  EXPECT_EQ(protected_frame(0x0123, 2), (Frame{std::byte{0x90}, std::byte{0x12}}));
}

TEST(E2e, FindsEveryErrorOfOneOrTwoBits) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20; ++round) {
    Frame frame{};
    for (std::byte& byte : frame) byte = static_cast<std::byte>(random() & 0xFF);
    frame = protected_frame(0x101, static_cast<std::uint8_t>(round % 15), frame);
    for (std::size_t a = 0; a < 64; ++a) {
      for (std::size_t b = a; b < 64; ++b) {
        Frame damaged = frame;
        damaged[a / 8] ^= static_cast<std::byte>(1U << a % 8);
        if (b != a) damaged[b / 8] ^= static_cast<std::byte>(1U << b % 8);
        EXPECT_EQ(E2eChecker(0x101).check(damaged), E2eStatus::wrong_crc) << a << ' ' << b;
      }
    }
  }
}

TEST(E2e, AFrameInThePlaceOfAnotherIsFound) {
  EXPECT_EQ(E2eChecker(0x101).check(protected_frame(0x102, 0)), E2eStatus::wrong_crc);
  EXPECT_EQ(E2eChecker(0x201).check(protected_frame(0x101, 0)), E2eStatus::wrong_crc);
  EXPECT_EQ(E2eChecker(0x101).check({}), E2eStatus::wrong_crc);
}

TEST(E2e, TheCounterTellsRepetitionFromLoss) {
  E2eChecker checker(0x101, 3);
  const auto check = [&](std::uint8_t counter) { return checker.check(protected_frame(0x101, counter)); };
  EXPECT_EQ(check(12), E2eStatus::ok);
  EXPECT_EQ(check(12), E2eStatus::repeated);
  EXPECT_EQ(check(13), E2eStatus::ok);
  EXPECT_EQ(check(14), E2eStatus::ok);
  EXPECT_EQ(check(0), E2eStatus::ok);
  EXPECT_EQ(check(3), E2eStatus::ok_some_lost);
  EXPECT_EQ(check(7), E2eStatus::wrong_sequence);
  EXPECT_EQ(check(8), E2eStatus::ok);
  EXPECT_EQ(check(7), E2eStatus::wrong_sequence);
  EXPECT_EQ(check(15), E2eStatus::wrong_crc);  // 15 is never sent
}

TEST(E2e, TheCounterRunsFrom0To14) {
  EXPECT_EQ(next_e2e_counter(0), 1);
  EXPECT_EQ(next_e2e_counter(14), 0);
}

}  // namespace
}  // namespace landfix::platform
