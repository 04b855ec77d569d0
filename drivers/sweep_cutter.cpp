#include "drivers/sweep_cutter.hpp"

#include <cmath>

namespace landfix::drivers {
namespace {

constexpr int kQuarterTurn = kTurnCentideg / 4;

constexpr int within_a_turn(int centideg) noexcept {
  const int remainder = centideg % kTurnCentideg;
  return remainder < 0 ? remainder + kTurnCentideg : remainder;
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
  const int step = within_a_turn(relative - position_ + kQuarterTurn) - kQuarterTurn;
  position_ += step;
  if (position_ < -kQuarterTurn) position_ = relative;  // not jitter: it turns the other way
  if (position_ < kTurnCentideg) return false;
  position_ -= kTurnCentideg;
  return true;
}

bool SweepCutter::would_cut_twice(std::span<const std::uint16_t> azimuths_centideg) const noexcept {
  SweepCutter ahead = *this;
  int cuts = 0;
  for (const std::uint16_t azimuth_centideg : azimuths_centideg)
    cuts += ahead.advance(azimuth_centideg) ? 1 : 0;
  return cuts > 1;
}

}  // namespace landfix::drivers
