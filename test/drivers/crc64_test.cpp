#include "drivers/ouster/crc64.hpp"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace landfix::drivers::ouster {
namespace {

/// Bit by bit, as the parameters say.
std::uint64_t by_definition(std::span<const std::byte> bytes) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint64_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc % 2 == 1 ? crc / 2 ^ 0xC96C'5795'D787'0F42 : crc / 2;
  }
  return ~crc;
}

TEST(Crc64, GivesTheCheckValue) {
  constexpr std::string_view kDigits = "123456789";
  const auto bytes = std::as_bytes(std::span(kDigits));
  EXPECT_EQ(crc64(bytes), 0x995D'C9BB'DF19'39FA);
  EXPECT_EQ(crc64_by_tables(bytes), 0x995D'C9BB'DF19'39FA);
}

TEST(Crc64, IsTheSameByEveryWayAndForEveryLength) {
  std::vector<std::byte> bytes(700);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>((i * i * 31 + i / 7) & 0xFF);
  for (std::size_t size = 0; size <= 600; ++size) {
    const auto part = std::span(bytes).subspan(size % 17, size);  // at any alignment
    const std::uint64_t expected = by_definition(part);
    ASSERT_EQ(crc64(part), expected) << size;
    ASSERT_EQ(crc64_by_tables(part), expected) << size;
  }
}

}  // namespace
}  // namespace landfix::drivers::ouster
