#include "drivers/velodyne/spin_rate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <numbers>

#include "drivers/sweep_cutter.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {
namespace {

// The sensors turn at 300 to 1200 rpm, 0.18 to 0.72; while starting up, slower.
constexpr double kSlowest_centideg_per_us = 0.12;
constexpr double kFastest_centideg_per_us = 1.08;
constexpr double kLowPass = 1.0 / 16.0;
/// A step of more than this many periods is a sector left out; of more than three quarters of a turn, one
/// back.
constexpr double kLeapPeriods = 3.0;
constexpr int kFarthestLeapCentideg = 3 * kTurnCentideg / 4;

}  // namespace

void SpinRate::update(std::span<const std::uint16_t> azimuths_centideg, double step_us) noexcept {
  const std::size_t count = std::min(azimuths_centideg.size(), kBlocks);
  if (count < 2) return;
  std::array<int, kBlocks> storage;
  const auto steps = std::span(storage).first(count - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = turned_centideg(azimuths_centideg[i], azimuths_centideg[i + 1]);
  }
  std::sort(steps.begin(), steps.end());
  const int median = steps[steps.size() / 2];
  int sum = 0;
  int used = 0;
  for (const int step : steps) {
    if (2 * std::abs(step - median) > median) continue;
    sum += step;
    ++used;
  }
  const double measured_centideg_per_us = static_cast<double>(sum) / (used * step_us);
  if (measured_centideg_per_us < kSlowest_centideg_per_us ||
      measured_centideg_per_us > kFastest_centideg_per_us)
    return;
  centideg_per_us_ += kLowPass * (measured_centideg_per_us - centideg_per_us_);
}

double SpinRate::rad_per_s() const noexcept {
  return centideg_per_us_ * 1e6 * (0.01 * std::numbers::pi / 180.0);
}

std::int64_t SpinRate::turn_ns() const noexcept {
  return static_cast<std::int64_t>(kTurnCentideg / centideg_per_us_ * 1e3);
}

std::int64_t SpinRate::time_between(std::uint16_t from_centideg, std::uint16_t to_centideg,
                                    std::int64_t period_ns) const noexcept {
  const int step_centideg = turned_centideg(from_centideg, to_centideg);
  const double step_ns = step_centideg / centideg_per_us_ * 1e3;
  const bool leaps =
      step_centideg < kFarthestLeapCentideg && step_ns > kLeapPeriods * static_cast<double>(period_ns);
  return leaps ? static_cast<std::int64_t>(step_ns) : period_ns;
}

}  // namespace landfix::drivers::velodyne
