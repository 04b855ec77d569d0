// How fast the rotor turns, from the azimuths of a packet: Velodyne does not say.
#pragma once

#include <cstdint>
#include <span>

namespace landfix::drivers::velodyne {

/// The difference to the next block alone would not do: the last block has none, the encoder is quantised
/// (one count in 40) and a restricted field of view jumps. So the steps near their median are averaged, and
/// the packets low-passed.
class SpinRate {
 public:
  /// Takes the azimuths of successive firings, `step_us` apart; at least two, or nothing happens.
  void update(std::span<const std::uint16_t> azimuths_centideg, double step_us) noexcept;

  [[nodiscard]] double rad_per_s() const noexcept;
  [[nodiscard]] std::int64_t turn_ns() const noexcept;

  /// Time from one firing to the next: `period_ns`, unless the azimuth leaps. A rotor does not; a restricted
  /// field of view fills the packet up behind the sector that it leaves out, when the rotor has got there.
  [[nodiscard]] std::int64_t time_between(std::uint16_t from_centideg, std::uint16_t to_centideg,
                                          std::int64_t period_ns) const noexcept;

 private:
  double centideg_per_us_ = 0.36;  ///< 600 rpm, until there is a packet
};

}  // namespace landfix::drivers::velodyne
