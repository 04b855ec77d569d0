// The VLP-16 as its maker describes it: beams and times (VLP-16 User Manual 63-9243 Rev D, section 9). The
// simulator has a table of its own, so that a slip in a decoder's cannot cancel out.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

namespace landfix::tools::simulator::vlp16 {

inline constexpr std::size_t kLasers = 16;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kSequencesPerBlock = 2;
inline constexpr std::size_t kFiringsPerBlock = kLasers * kSequencesPerBlock;
inline constexpr std::size_t kFiringsPerPacket = kBlocks * kFiringsPerBlock;

inline constexpr std::int64_t kFiring_ns = 2'304;
inline constexpr std::int64_t kSequence_ns = 55'296;  // 16 firings and a recharge of 18.432 us
inline constexpr std::int64_t kBlock_ns = 2 * kSequence_ns;
inline constexpr std::int64_t kPacket_ns = kBlocks * kBlock_ns;

inline constexpr double kMinRange_m = 0.5;
inline constexpr double kMaxRange_m = 100.0;
inline constexpr double kDistanceUnit_m = 0.002;
/// The data sheet's +-3 cm, read as three standard deviations.
inline constexpr double kRangeNoise_m = 0.01;

struct Beam {
  double elevation_deg;
  double vertical_offset_mm;  ///< of the beam's origin, above the optical centre
};

/// In the order in which they fire.
inline constexpr std::array<Beam, kLasers> kBeams{{{-15.0, 11.2},
                                                   {1.0, -0.7},
                                                   {-13.0, 9.7},
                                                   {3.0, -2.2},
                                                   {-11.0, 8.1},
                                                   {5.0, -3.7},
                                                   {-9.0, 6.6},
                                                   {7.0, -5.1},
                                                   {-7.0, 5.1},
                                                   {9.0, -6.6},
                                                   {-5.0, 3.7},
                                                   {11.0, -8.1},
                                                   {-3.0, 2.2},
                                                   {13.0, -9.7},
                                                   {-1.0, 0.7},
                                                   {15.0, -11.2}}};

/// After the packet's first firing; `firing` counts the packet's 384 in order.
[[nodiscard]] constexpr std::int64_t firing_time_ns(std::size_t firing) noexcept {
  return static_cast<std::int64_t>(firing / kLasers) * kSequence_ns +
         static_cast<std::int64_t>(firing % kLasers) * kFiring_ns;
}

/// Where the rotor points at 600 rpm, clockwise from the front [deg]. It is locked to the second, as with the
/// sensor's phase lock at 0 deg.
[[nodiscard]] constexpr double rotor_angle_deg(std::int64_t utc_ns) noexcept {
  constexpr std::int64_t kTurn_ns = 100'000'000;
  return 360.0 * static_cast<double>(utc_ns % kTurn_ns) / static_cast<double>(kTurn_ns);
}

/// Frame `sensor`: x forward, y left, z up. `azimuth_deg` is clockwise from the front.
[[nodiscard]] inline Eigen::Vector3d beam_direction(const Beam& beam, double azimuth_deg) noexcept {
  const double elevation_rad = beam.elevation_deg * std::numbers::pi / 180.0;
  const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), -std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}
[[nodiscard]] inline Eigen::Vector3d beam_origin_m(const Beam& beam) noexcept {
  return {0.0, 0.0, 1e-3 * beam.vertical_offset_mm};
}

}  // namespace landfix::tools::simulator::vlp16
