// Where one turn ends and the next begins: a state machine over the azimuth of blocks, not of points, so that
// dual returns and the lasers of one firing stay together.
#pragma once

#include <cstdint>
#include <span>

namespace landfix::drivers {

inline constexpr int kTurnCentideg = 36000;

/// Forward from one azimuth to another, 0 to 35999.
[[nodiscard]] constexpr int turned_centideg(std::uint16_t from_centideg, std::uint16_t to_centideg) noexcept {
  const int step_centideg = to_centideg - from_centideg;
  return step_centideg < 0 ? step_centideg + kTurnCentideg : step_centideg;
}

/// For a rotor that turns clockwise. A step from block to block is read as at most a quarter turn back
/// (jitter of the encoder, a packet out of order) and less than three quarters forward (a dark sector, lost
/// packets): so a step back over the cut and forward again does not cut twice.
class SweepCutter {
 public:
  /// `cut_deg`: azimuth of the cut, clockwise from the sensor's front; any finite number of turns.
  explicit SweepCutter(double cut_deg) noexcept;

  /// Takes the next block's azimuth, 0 to 35999. True if the cut has been passed since the block before.
  [[nodiscard]] bool advance(std::uint16_t azimuth_centideg) noexcept;

  /// Whether a packet with blocks at these azimuths would be cut more than once or turn a whole turn: no
  /// rotor turns that far in a packet, so one of them is damaged.
  [[nodiscard]] bool cannot_be(std::span<const std::uint16_t> azimuths_centideg) const noexcept;

  /// Forgets where the rotor was.
  void restart() noexcept { started_ = false; }

 private:
  int cut_centideg_;
  int position_ = 0;  ///< turned since the cut [0.01 deg], negative just after a step back over it
  bool started_ = false;
};

}  // namespace landfix::drivers
