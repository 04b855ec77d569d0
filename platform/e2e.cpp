#include "platform/e2e.hpp"

#include <array>

namespace landfix::platform {
namespace {

/// CRC-8 of SAE J1850, x^8 + x^4 + x^3 + x^2 + 1, a byte at a time.
constexpr std::array<std::uint8_t, 256> kCrcTable = [] {
  std::array<std::uint8_t, 256> table{};
  for (unsigned value = 0; value < 256; ++value) {
    unsigned crc = value;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0 ? crc << 1 ^ 0x11DU : crc << 1;
    table[value] = static_cast<std::uint8_t>(crc);
  }
  return table;
}();

// In profile 11 the start and final values of the two library calls cancel: both are 0 in effect.
std::uint8_t crc_of(std::span<const std::byte> frame, std::uint16_t data_id) noexcept {
  std::uint8_t crc = kCrcTable[data_id & 0xFFU];
  crc = kCrcTable[crc];  // variant C: in place of the data id's high byte, 0
  for (const std::byte byte : frame.subspan(1)) crc = kCrcTable[crc ^ std::to_integer<std::uint8_t>(byte)];
  return crc;
}

constexpr std::uint8_t id_nibble(std::uint16_t data_id) noexcept {
  return static_cast<std::uint8_t>(data_id >> 8 & 0x0FU);
}

}  // namespace

void e2e_protect(std::span<std::byte> frame, std::uint16_t data_id, std::uint8_t counter) noexcept {
  frame[1] = static_cast<std::byte>(id_nibble(data_id) << 4 | counter);
  frame[0] = std::byte{crc_of(frame, data_id)};
}

E2eStatus E2eChecker::check(std::span<const std::byte> frame) noexcept {
  if (frame.size() < kE2eHeaderBytes) return E2eStatus::wrong_crc;
  const auto header = std::to_integer<std::uint8_t>(frame[1]);
  const auto counter = static_cast<std::uint8_t>(header & 0x0FU);
  const bool intact = frame[0] == std::byte{crc_of(frame, data_id_)} && header >> 4 == id_nibble(data_id_) &&
                      counter < kE2eCounterEnd;
  if (!intact) return E2eStatus::wrong_crc;

  const int step = counter_ ? (counter - *counter_ + kE2eCounterEnd) % kE2eCounterEnd : 1;
  counter_ = counter;
  if (step == 0) return E2eStatus::repeated;
  if (step == 1) return E2eStatus::ok;
  return step <= max_counter_step_ ? E2eStatus::ok_some_lost : E2eStatus::wrong_sequence;
}

}  // namespace landfix::platform
