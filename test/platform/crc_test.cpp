#include "platform/crc.hpp"

#include <string_view>

#include <gtest/gtest.h>

#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

std::span<const std::byte> check_text() {
  constexpr std::string_view kText = "123456789";
  return std::as_bytes(std::span(kText));
}

/// With the start and final values of SAE J1850, as the published values are given.
unsigned j1850(std::span<const std::byte> data) { return crc8(data, 0xFF) ^ 0xFFU; }

TEST(Crc, GivesTheCheckValues) {
  EXPECT_EQ(crc8(check_text()), 0x37);
  EXPECT_EQ(j1850(check_text()), 0x4BU);
  EXPECT_EQ(crc16(check_text()), 0x29B1);
}

TEST(Crc, GivesThePatternsOfAutosar) {
  struct Pattern {
    Bytes data;
    unsigned j1850;
    unsigned crc16;
  };
  const std::vector<Pattern> patterns{
      {bytes({0, 0, 0, 0}), 0x59, 0x84C0},
      {bytes({0xF2, 0x01, 0x83}), 0x37, 0xD374},
      {bytes({0x0F, 0xAA, 0x00, 0x55}), 0x79, 0x2023},
      {bytes({0x00, 0xFF, 0x55, 0x11}), 0xB8, 0xB8F9},
      {bytes({0x33, 0x22, 0x55, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF}), 0xCB, 0xF53F},
      {bytes({0x92, 0x6B, 0x55}), 0x8C, 0x0745},
      {bytes({0xFF, 0xFF, 0xFF, 0xFF}), 0x74, 0x1D0F},
  };
  for (const Pattern& pattern : patterns) {
    EXPECT_EQ(j1850(pattern.data), pattern.j1850);
    EXPECT_EQ(crc16(pattern.data), pattern.crc16);
  }
}

TEST(Crc, OfNothingIsWhatCameBefore) {
  EXPECT_EQ(crc8({}), 0);
  EXPECT_EQ(crc8({}, 0x5A), 0x5A);
  EXPECT_EQ(crc16({}), 0xFFFF);
}

}  // namespace
}  // namespace landfix::platform
