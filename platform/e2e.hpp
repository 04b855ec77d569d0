// End-to-end protection of frames, AUTOSAR profile 11 variant C: who receives a frame can tell whether it was
// damaged, lost, repeated or put in the place of another.
//
//   byte 0: CRC-8 over the data id and all that follows
//   byte 1: counter 0..14 (low nibble), bits 8..11 of the data id (high nibble)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace landfix::platform {

inline constexpr std::size_t kE2eHeaderBytes = 2;
inline constexpr std::uint8_t kE2eCounterEnd = 15;  ///< counters run from 0 to 14

/// The counter of the next frame.
[[nodiscard]] constexpr std::uint8_t next_e2e_counter(std::uint8_t counter) noexcept {
  return static_cast<std::uint8_t>((counter + 1) % kE2eCounterEnd);
}

/// Fills in the header of `frame`, 2 bytes or more, whose payload is in place.
void e2e_protect(std::span<std::byte> frame, std::uint16_t data_id, std::uint8_t counter) noexcept;

enum class E2eStatus : std::uint8_t {
  ok,
  ok_some_lost,    ///< frames before this one are missing, not more than are tolerated
  repeated,        ///< the counter stands still
  wrong_sequence,  ///< more frames are missing than are tolerated
  wrong_crc,       ///< damaged, or not the frame that was expected
};

/// Of one stream of frames. That none arrives is for the caller's time-out to find.
class E2eChecker {
 public:
  /// `max_counter_step`: the largest step, 1 to 14, from one frame to the next that is still `ok_some_lost`.
  explicit E2eChecker(std::uint16_t data_id, std::uint8_t max_counter_step = 3) noexcept
      : data_id_(data_id), max_counter_step_(max_counter_step) {}

  /// The first intact frame is `ok` whatever its counter.
  [[nodiscard]] E2eStatus check(std::span<const std::byte> frame) noexcept;

 private:
  std::uint16_t data_id_;
  std::uint8_t max_counter_step_;
  std::optional<std::uint8_t> counter_;
};

}  // namespace landfix::platform
