#include "platform/e2e.hpp"

#include <random>

#include <gtest/gtest.h>

#include "platform/crc.hpp"
#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;
using enum E2eProfile;

Bytes protected_frame(E2eProfile profile, std::uint16_t data_id, std::uint8_t counter,
                      Bytes frame = Bytes(8)) {
  e2e_protect(profile, frame, data_id, counter);
  return frame;
}

E2eStatus first_status(E2eProfile profile, std::uint16_t data_id, const Bytes& frame) {
  return E2eChecker(profile, data_id).check(frame).status;
}

// Eight zero bytes, three frames in a row.
TEST(E2e, GivesTheVectorsOfProfile11C) {
  EXPECT_EQ(protected_frame(p11c, 0x0123, 0), bytes({0x2A, 0x10}) + Bytes(6));
  EXPECT_EQ(protected_frame(p11c, 0x0123, 1), bytes({0x77, 0x11}) + Bytes(6));
  EXPECT_EQ(protected_frame(p11c, 0x0123, 2), bytes({0x90, 0x12}) + Bytes(6));
}

TEST(E2e, GivesTheVectorsOfProfile5) {
  EXPECT_EQ(protected_frame(p05, 0x1234, 0), bytes({0x1C, 0xCA, 0x00}) + Bytes(5));
  EXPECT_EQ(protected_frame(p05, 0x1234, 1), bytes({0xCF, 0x8D, 0x01}) + Bytes(5));
  EXPECT_EQ(protected_frame(p05, 0x1234, 2), bytes({0xBA, 0x45, 0x02}) + Bytes(5));
  // The vector with 16 bytes and the header after 8 of them: 28 91 00, from the same checksum.
  EXPECT_EQ(crc16(bytes({0x34, 0x12}), crc16(Bytes(8 + 6))), 0x9128);
}

TEST(E2e, FindsEveryErrorOfOneOrTwoBits) {
  std::mt19937_64 random(1);
  for (const E2eProfile profile : {p11c, p05}) {
    for (int round = 0; round < 20; ++round) {
      Bytes frame(8);
      for (std::byte& byte : frame) byte = static_cast<std::byte>(random() & 0xFF);
      frame = protected_frame(profile, 0x101, static_cast<std::uint8_t>(round % 15), frame);
      for (std::size_t a = 0; a < 64; ++a) {
        for (std::size_t b = a; b < 64; ++b) {
          Bytes damaged = frame;
          damaged[a / 8] ^= static_cast<std::byte>(1U << a % 8);
          if (b != a) damaged[b / 8] ^= static_cast<std::byte>(1U << b % 8);
          EXPECT_EQ(first_status(profile, 0x101, damaged), E2eStatus::wrong_crc) << a << ' ' << b;
        }
      }
    }
  }
}

TEST(E2e, AFrameInThePlaceOfAnotherIsFound) {
  for (const E2eProfile profile : {p11c, p05}) {
    EXPECT_EQ(first_status(profile, 0x101, protected_frame(profile, 0x101, 0)), E2eStatus::ok);
    EXPECT_EQ(first_status(profile, 0x101, protected_frame(profile, 0x102, 0)), E2eStatus::wrong_crc);
    EXPECT_EQ(first_status(profile, 0x201, protected_frame(profile, 0x101, 0)), E2eStatus::wrong_crc);
    EXPECT_EQ(first_status(profile, 0x101, {}), E2eStatus::wrong_crc);
    EXPECT_EQ(first_status(profile, 0x101, Bytes(1)), E2eStatus::wrong_crc);
  }
}

TEST(E2e, TheCounterTellsRepetitionFromLoss) {
  E2eChecker checker(p11c, 0x101, 3);
  const auto check = [&](std::uint8_t counter) {
    return checker.check(protected_frame(p11c, 0x101, counter)).status;
  };
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

TEST(E2e, TheCheckSaysHowFarTheCounterWent) {
  E2eChecker checker(p05, 0x10A);
  (void)checker.check(protected_frame(p05, 0x10A, 254));
  const E2eCheck check = checker.check(protected_frame(p05, 0x10A, 1));
  EXPECT_EQ(check.status, E2eStatus::ok_some_lost);
  EXPECT_EQ(check.counter, 1);
  EXPECT_EQ(check.step, 3U);
}

TEST(E2e, TheCounterRunsFrom0To14Or255) {
  EXPECT_EQ(next_e2e_counter(p11c, 0), 1);
  EXPECT_EQ(next_e2e_counter(p11c, 14), 0);
  EXPECT_EQ(next_e2e_counter(p05, 14), 15);
  EXPECT_EQ(next_e2e_counter(p05, 255), 0);
}

}  // namespace
}  // namespace landfix::platform
