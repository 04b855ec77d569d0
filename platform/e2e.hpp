// End-to-end protection of frames (AUTOSAR): who receives a frame can tell whether it was damaged, lost,
// repeated or put in the place of another. The data id, which says what frame it is, is part of the checksum
// and not, or not whole, of the frame.
//
//   profile 11C, classic CAN:  byte 0     CRC-8 over the data id and all that follows
//                              byte 1     counter 0..14 (low nibble), bits 8..11 of the data id (high nibble)
//   profile 5, CAN FD:         bytes 0-1  CRC-16, low byte first, over all that follows and the data id
//                              byte 2     counter 0..255
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace landfix::platform {

enum class E2eProfile : std::uint8_t { p11c, p05 };

[[nodiscard]] constexpr std::size_t e2e_header_bytes(E2eProfile profile) noexcept {
  return profile == E2eProfile::p11c ? 2 : 3;
}

/// Counters run from 0 to one less.
[[nodiscard]] constexpr unsigned e2e_counter_end(E2eProfile profile) noexcept {
  return profile == E2eProfile::p11c ? 15 : 256;
}

/// The counter of the next frame.
[[nodiscard]] constexpr std::uint8_t next_e2e_counter(E2eProfile profile, std::uint8_t counter) noexcept {
  return static_cast<std::uint8_t>((counter + 1U) % e2e_counter_end(profile));
}

/// Fills in the header of `frame`, which has room for it and whose payload is in place.
void e2e_protect(E2eProfile profile, std::span<std::byte> frame, std::uint16_t data_id,
                 std::uint8_t counter) noexcept;

enum class E2eStatus : std::uint8_t {
  ok,
  ok_some_lost,    ///< frames before this one are missing, not more than are tolerated
  repeated,        ///< the counter stands still
  wrong_sequence,  ///< more frames are missing than are tolerated, or it is older than the one before
  wrong_crc,       ///< damaged, or not the frame that was expected
};

/// Whether the frame's content may be used.
[[nodiscard]] constexpr bool is_accepted(E2eStatus status) noexcept {
  return status == E2eStatus::ok || status == E2eStatus::ok_some_lost;
}

struct E2eCheck {
  E2eStatus status = E2eStatus::wrong_crc;
  std::uint8_t counter = 0;  ///< of this frame, where it is intact
  unsigned step = 0;         ///< from the counter before; 1 where none is missing
};

/// Of one stream of frames. That none arrives is for the caller's time-out to find.
class E2eChecker {
 public:
  /// `max_counter_step`: the largest step from one frame to the next that is still `ok_some_lost`.
  E2eChecker(E2eProfile profile, std::uint16_t data_id, unsigned max_counter_step = 3) noexcept
      : profile_(profile), data_id_(data_id), max_counter_step_(max_counter_step) {}
  /// To be assigned another.
  E2eChecker() = default;

  /// The first intact frame is `ok` whatever its counter.
  [[nodiscard]] E2eCheck check(std::span<const std::byte> frame) noexcept;

 private:
  E2eProfile profile_ = E2eProfile::p11c;
  std::uint16_t data_id_ = 0;
  unsigned max_counter_step_ = 3;
  std::optional<std::uint8_t> counter_;
};

}  // namespace landfix::platform
