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

 private:
  double centideg_per_us_ = 0.36;  ///< 600 rpm, until there is a packet
};

}  // namespace landfix::drivers::velodyne
