#include "drivers/robosense/rotation.hpp"

#include <cstddef>

#include "drivers/sweep_cutter.hpp"

namespace landfix::drivers::robosense {
namespace {

constexpr double kCentidegPerUsAtOneRpm = 0.36 / 600.0;
constexpr unsigned kNominalRpm = 600;
// 150 to 2400 rpm: the sensors are set to 300 to 1200.
constexpr double kSlowest = 150 * kCentidegPerUsAtOneRpm;
constexpr double kFastest = 2400 * kCentidegPerUsAtOneRpm;
/// Less than half a turn at the fastest: what is further apart could have turned more than once.
constexpr std::int64_t kLongestNs = 10'000'000;
constexpr double kLowPass = 1.0 / 16.0;

}  // namespace

double mean_step_centideg(std::span<const std::uint16_t> azimuths_centideg) noexcept {
  int sum = 0;
  int count = 0;
  for (std::size_t i = 1; i < azimuths_centideg.size(); ++i) {
    const int step = turned_centideg(azimuths_centideg[i - 1], azimuths_centideg[i]);
    if (step > kWidestStepCentideg) continue;
    sum += step;
    ++count;
  }
  return count == 0 ? 0.0 : static_cast<double>(sum) / count;
}

void RotorSpeed::set_nominal(unsigned motor_rpm) noexcept {
  if (!measured_) centideg_per_us_ = (motor_rpm == 0 ? kNominalRpm : motor_rpm) * kCentidegPerUsAtOneRpm;
}

void RotorSpeed::update(std::uint16_t azimuth_centideg, std::int64_t sensor_ns) noexcept {
  const std::int64_t elapsed_ns = sensor_ns - last_ns_;
  if (started_ && elapsed_ns > 0 && elapsed_ns <= kLongestNs) {
    const double speed =
        turned_centideg(last_azimuth_centideg_, azimuth_centideg) / (static_cast<double>(elapsed_ns) * 1e-3);
    if (speed >= kSlowest && speed <= kFastest) {
      centideg_per_us_ += (measured_ ? kLowPass : 1.0) * (speed - centideg_per_us_);
      measured_ = true;
    }
  }
  started_ = true;
  last_ns_ = sensor_ns;
  last_azimuth_centideg_ = azimuth_centideg;
}

}  // namespace landfix::drivers::robosense
