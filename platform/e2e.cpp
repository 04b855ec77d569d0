#include "platform/e2e.hpp"

#include <algorithm>
#include <array>

#include "platform/crc.hpp"

namespace landfix::platform {
namespace {

/// What precedes the payload.
struct Header {
  std::array<std::byte, 3> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::byte> all() const noexcept { return std::span(bytes).first(size); }
};

// In profile 11 the start and final values of the CRC library's two calls cancel: both are 0 in effect.
// Variant C takes a 0 in place of the data id's high byte, of which the frame holds a nibble.
Header header_11c(std::span<const std::byte> payload, std::uint16_t data_id, std::uint8_t counter) noexcept {
  const std::array id{static_cast<std::byte>(data_id & 0xFFU), std::byte{0}};
  const std::array nibbles{static_cast<std::byte>((data_id >> 8 & 0x0FU) << 4 | (counter & 0x0FU))};
  const std::uint8_t crc = crc8(payload, crc8(nibbles, crc8(id)));
  return {.bytes = {std::byte{crc}, nibbles[0]}, .size = 2};
}

Header header_05(std::span<const std::byte> payload, std::uint16_t data_id, std::uint8_t counter) noexcept {
  const std::array id{static_cast<std::byte>(data_id & 0xFFU), static_cast<std::byte>(data_id >> 8)};
  const std::array count{std::byte{counter}};
  const std::uint16_t crc = crc16(id, crc16(payload, crc16(count)));
  return {.bytes = {static_cast<std::byte>(crc & 0xFFU), static_cast<std::byte>(crc >> 8), count[0]},
          .size = 3};
}

Header header_of(E2eProfile profile, std::span<const std::byte> frame, std::uint16_t data_id,
                 std::uint8_t counter) noexcept {
  const auto payload = frame.subspan(e2e_header_bytes(profile));
  return profile == E2eProfile::p11c ? header_11c(payload, data_id, counter)
                                     : header_05(payload, data_id, counter);
}

std::uint8_t counter_of(E2eProfile profile, std::span<const std::byte> frame) noexcept {
  return profile == E2eProfile::p11c ? std::to_integer<std::uint8_t>(frame[1] & std::byte{0x0F})
                                     : std::to_integer<std::uint8_t>(frame[2]);
}

}  // namespace

void e2e_protect(E2eProfile profile, std::span<std::byte> frame, std::uint16_t data_id,
                 std::uint8_t counter) noexcept {
  const Header header = header_of(profile, frame, data_id, counter);
  std::copy(header.all().begin(), header.all().end(), frame.begin());
}

E2eCheck E2eChecker::check(std::span<const std::byte> frame) noexcept {
  if (frame.size() < e2e_header_bytes(profile_)) return {};
  const std::uint8_t counter = counter_of(profile_, frame);
  const Header expected = header_of(profile_, frame, data_id_, counter);
  const bool is_intact = std::equal(expected.all().begin(), expected.all().end(), frame.begin());
  const unsigned end = e2e_counter_end(profile_);
  if (!is_intact || counter >= end) return {};

  const unsigned step = counter_ ? (counter + end - *counter_) % end : 1;
  counter_ = counter;
  E2eStatus status = E2eStatus::wrong_sequence;
  if (step == 0)
    status = E2eStatus::repeated;
  else if (step == 1)
    status = E2eStatus::ok;
  else if (step <= max_counter_step_)
    status = E2eStatus::ok_some_lost;
  return {.status = status, .counter = counter, .step = step};
}

}  // namespace landfix::platform
