#include "drivers/sweep_cutter.hpp"

#include <cmath>

namespace landfix::drivers {
namespace {

constexpr int kQuarterTurn = kTurnCentideg / 4;

constexpr int within_a_turn(int centideg) noexcept {
  const int remainder = centideg % kTurnCentideg;
  return remainder < 0 ? remainder + kTurnCentideg : remainder;
}

/// From one azimuth to the next, -9000 to 26999.
constexpr int step_between(int from_centideg, int to_centideg) noexcept {
  return within_a_turn(to_centideg - from_centideg + kQuarterTurn) - kQuarterTurn;
}

}  // namespace

SweepCutter::SweepCutter(double cut_deg) noexcept
    : cut_centideg_(static_cast<int>(std::lround(std::fmod(cut_deg, 360.0) * 100.0))) {}

bool SweepCutter::advance(std::uint16_t azimuth_centideg) noexcept {
  const int relative = within_a_turn(azimuth_centideg - cut_centideg_);
  if (!started_) {
    started_ = true;
    position_ = relative;
    return false;
  }
  position_ += step_between(position_, relative);
  if (position_ < -kQuarterTurn) position_ = relative;  // not jitter: it turns the other way
  if (position_ < kTurnCentideg) return false;
  position_ -= kTurnCentideg;
  return true;
}

bool SweepCutter::cannot_be(std::span<const std::uint16_t> azimuths_centideg) const noexcept {
  SweepCutter ahead = *this;
  int cuts = 0;
  int turned = 0;
  for (std::size_t i = 0; i < azimuths_centideg.size(); ++i) {
    cuts += ahead.advance(azimuths_centideg[i]) ? 1 : 0;
    if (i > 0) turned += step_between(azimuths_centideg[i - 1], azimuths_centideg[i]);
  }
  return cuts > 1 || turned >= kTurnCentideg;
}

}  // namespace landfix::drivers
