#include "drivers/velodyne/hdl64_projector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/beam.hpp"
#include "drivers/centidegrees.hpp"
#include "drivers/little_endian.hpp"
#include "drivers/widest.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kHdl64RangeUnit_m = 0.002;

// Where the factory measures the corrections (appendix F).
constexpr double kFarM = 25.04;
constexpr double kNearSideM = 2.40;
constexpr double kNearAheadM = 1.93;

/// The full scale of the ranges, and its square's factor in the correction of the intensity (appendix F).
constexpr double kFocalScaleM = 131.0;
constexpr float kFocalGain = 256.0F;

/// Admits no return.
constexpr RawBounds kNothing{.least = 2, .most = 1};

/// Firing times of laser 0 to 31 of a block. S2 and S3: groups of four (appendix E). The S1's documents give
/// none: its lasers are spread evenly over the block.
double firing_time_us(Hdl64Layout layout, std::size_t laser) noexcept {
  constexpr std::array kSingleUs{0.0, 1.26, 2.46, 3.66};
  constexpr std::array kDualUs{0.0, 1.3, 2.5, 3.7};
  const std::size_t number = laser / 4;
  const auto group = static_cast<double>(number);
  switch (layout) {
    case Hdl64Layout::single:
      return 6.0 * group + kSingleUs[laser % 4];
    case Hdl64Layout::dual:
      return 7.2 * group + kDualUs[laser % 4];
    case Hdl64Layout::s1:
      break;
  }
  return static_cast<double>(laser);
}

/// The correction near the sensor as a line over the distance: its value at the axis, and how it grows.
struct Line {
  double at_axis_m;
  double growth;
};
Line line(double near_m, double near_correction_m, double far_correction_m) noexcept {
  const double growth = (far_correction_m - near_correction_m) / (kFarM - near_m);
  return {near_correction_m - near_m * growth, growth};
}

}  // namespace

Hdl64Projector::Hdl64Projector(const DecoderOptions& options) noexcept
    : min_range_m_(options.min_range_m),
      max_range_m_(options.max_range_m),
      firing_time_azimuth_(options.firing_time_azimuth),
      two_point_correction_(options.two_point_correction),
      vertical_offsets_(options.vertical_offsets) {
  set_calibration({});
}

void Hdl64Projector::set_calibration(const Hdl64Calibration& calibration) noexcept {
  const auto& lasers = calibration.lasers;
  for (std::size_t i = 0; i < kHdl64Lasers; ++i) {
    set_laser(i, lasers[i], !calibration.intensity_is_corrected);
    ring_[i] = ring_of(i, kHdl64Lasers, [&](std::size_t laser) { return lasers[laser].elevation_deg; });
  }
  turn_on();
}

void Hdl64Projector::set_laser(std::size_t i, const Hdl64Laser& laser, bool correct_intensity) noexcept {
  rotation_rad_[i] = laser.rotation_deg * kRadPerDeg;
  range_m_[i] = static_cast<float>(laser.range_m);
  const double near_side_m = two_point_correction_ ? laser.range_x_m : laser.range_m;
  const double near_ahead_m = two_point_correction_ ? laser.range_y_m : laser.range_m;
  const Line side = line(kNearSideM, near_side_m, laser.range_m);
  const Line ahead = line(kNearAheadM, near_ahead_m, laser.range_m);
  side_at_axis_m_[i] = static_cast<float>(side.at_axis_m);
  side_growth_[i] = static_cast<float>(side.growth);
  ahead_at_axis_m_[i] = static_cast<float>(ahead.at_axis_m);
  ahead_growth_[i] = static_cast<float>(ahead.growth);
  cos_elevation_[i] = static_cast<float>(std::cos(laser.elevation_deg * kRadPerDeg));
  sin_elevation_[i] = static_cast<float>(std::sin(laser.elevation_deg * kRadPerDeg));
  vertical_offset_m_[i] = vertical_offsets_ ? static_cast<float>(laser.vertical_offset_m) : 0.0F;
  horizontal_offset_m_[i] = static_cast<float>(laser.horizontal_offset_m);
  const double out_of_focus = 1.0 - laser.focal_distance_m / kFocalScaleM;
  focal_slope_[i] = correct_intensity ? static_cast<float>(laser.focal_slope) : 0.0F;
  focus_[i] = kFocalGain * static_cast<float>(out_of_focus * out_of_focus);
  min_intensity_[i] = correct_intensity ? static_cast<float>(laser.min_intensity) : 0.0F;
  max_intensity_[i] = correct_intensity ? static_cast<float>(laser.max_intensity) : 255.0F;
  // The far correction is off by centimetres at most.
  const RawBounds bounds =
      laser.enabled
          ? RangeGate(kHdl64RangeUnit_m, min_range_m_ - laser.range_m, max_range_m_ - laser.range_m).bounds()
          : kNothing;
  least_raw_[i] = bounds.least;
  most_raw_[i] = bounds.most;
}

void Hdl64Projector::set_rotation(Hdl64Layout layout, double rad_per_s) noexcept {
  const double longest_s = 1e-6 * firing_time_us(layout, kLasersPerBlock - 1);
  const bool same_speed = std::abs(rad_per_s - turn_rate_rad_per_s_) * longest_s < kLeastTurnRad;
  if (layout == layout_ && same_speed) return;
  layout_ = layout;
  turn_rate_rad_per_s_ = rad_per_s;
  turn_on();
}

void Hdl64Projector::turn_on() noexcept {
  for (std::size_t i = 0; i < kHdl64Lasers; ++i) {
    const double time_s = 1e-6 * firing_time_us(layout_, i % kLasersPerBlock);
    const double turned_rad = firing_time_azimuth_ ? turn_rate_rad_per_s_ * time_s : 0.0;
    cosine_[i] = static_cast<float>(std::cos(turned_rad - rotation_rad_[i]));
    sine_[i] = static_cast<float>(std::sin(turned_rad - rotation_rad_[i]));
    time_s_[i] = static_cast<float>(time_s);
  }
}

void Hdl64Projector::project(const Block& block, Sweep& sweep) const noexcept {
  if (const auto room = sweep.unused(); room.size() >= kLasersPerBlock) {
    const SlotPoints written = project_lasers(block, room);
    sweep.take(written.count, written.latest_s);
    return;
  }
  std::array<Point, kLasersPerBlock> points;  // what does not fit is counted
  const SlotPoints written = project_lasers(block, points);
  for (const Point& point : std::span(points).first(written.count)) sweep.push(point);
}

LANDFIX_WIDEST SlotPoints Hdl64Projector::project_lasers(const Block& block,
                                                         std::span<Point> points) const noexcept {
  constexpr std::size_t kCount = kLasersPerBlock;
  SlotColumns<kCount> columns;
  read_slots(block.slots, block.duplicates, kCount, ByteOrder::little, columns);
  auto& [words, x, y, z, intensity, kept] = columns;
  const std::size_t first = block.first_laser;
  const SineCosine azimuth = sine_cosine(block.azimuth_centideg);
  const auto block_cosine = static_cast<float>(azimuth.cosine);
  const auto block_sine = static_cast<float>(azimuth.sine);
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t laser = first + i;
    const float cosine = block_cosine * cosine_[laser] - block_sine * sine_[laser];
    const float sine = block_sine * cosine_[laser] + block_cosine * sine_[laser];
    const std::uint32_t range_raw = range_of(words[i]);
    const auto raw = static_cast<float>(static_cast<std::int32_t>(range_raw));
    const float measured_m = raw * static_cast<float>(kHdl64RangeUnit_m);
    const float far_m = measured_m + range_m_[laser];
    const float horizontal_m = far_m * cos_elevation_[laser];
    const float offset_m = horizontal_offset_m_[laser];
    const float side_m = std::abs(horizontal_m * sine - offset_m * cosine);
    const float ahead_m = std::abs(horizontal_m * cosine + offset_m * sine);
    const bool is_far = far_m >= static_cast<float>(kFarM);
    const float near_x_m = side_at_axis_m_[laser] + side_growth_[laser] * side_m;
    const float near_y_m = ahead_at_axis_m_[laser] + ahead_growth_[laser] * ahead_m;
    const float range_x_m = measured_m + (is_far ? range_m_[laser] : near_x_m);
    const float range_y_m = measured_m + (is_far ? range_m_[laser] : near_y_m);
    // The manual's x points right and its y forward.
    x[i] = range_y_m * cos_elevation_[laser] * cosine + offset_m * sine;
    y[i] = offset_m * cosine - range_x_m * cos_elevation_[laser] * sine;
    z[i] = range_y_m * sin_elevation_[laser] + vertical_offset_m_[laser];

    const float nearness = 1.0F - raw * (1.0F / 65535.0F);
    const float dimmed = focal_slope_[laser] * std::abs(focus_[laser] - kFocalGain * nearness * nearness);
    intensity[i] =
        std::min(std::max(intensity_of(words[i]) + dimmed, min_intensity_[laser]), max_intensity_[laser]);
    kept[i] = range_raw >= least_raw_[laser] && range_raw <= most_raw_[laser] ? 1 : 0;
  }
  return write_points(columns, kCount, block.time_s, &time_s_[first], &ring_[first], points);
}

}  // namespace landfix::drivers::velodyne
