#include <array>

#include <gtest/gtest.h>

#include "drivers/big_endian.hpp"
#include "drivers/little_endian.hpp"

namespace landfix::drivers {
namespace {

/// The fields begin at the second byte, so that none is aligned.
constexpr std::array<std::byte, 9> kBytes{std::byte{0xFF}, std::byte{0x81}, std::byte{0x02},
                                          std::byte{0x03}, std::byte{0x04}, std::byte{0x05},
                                          std::byte{0x06}, std::byte{0x07}, std::byte{0x88}};
constexpr const std::byte* kField = kBytes.data() + 1;

TEST(ByteOrder, LoadsTheMostSignificantByteFirst) {
  static_assert(load_big_endian<std::uint16_t>(kField) == 0x8102);
  EXPECT_EQ(load_big_endian<std::uint8_t>(kField), 0x81);
  EXPECT_EQ(load_big_endian<std::uint32_t>(kField), 0x81020304U);
  EXPECT_EQ((load_big_endian<std::uint32_t, 3>(kField)), 0x810203U);
  EXPECT_EQ((load_big_endian<std::uint64_t, 6>(kField)), 0x810203040506ULL);
  EXPECT_EQ(load_big_endian<std::uint64_t>(kField), 0x8102030405060788ULL);
}

TEST(ByteOrder, LoadsTheLeastSignificantByteFirst) {
  EXPECT_EQ(load_little_endian<std::uint8_t>(kField), 0x81);
  EXPECT_EQ(load_little_endian<std::uint16_t>(kField), 0x0281);
  EXPECT_EQ(load_little_endian<std::uint32_t>(kField), 0x04030281U);
  EXPECT_EQ((load_little_endian<std::uint32_t, 3>(kField)), 0x030281U);
  EXPECT_EQ((load_little_endian<std::uint64_t, 5>(kField)), 0x0504030281ULL);
  EXPECT_EQ(load_little_endian<std::uint64_t>(kField), 0x8807060504030281ULL);
}

}  // namespace
}  // namespace landfix::drivers
