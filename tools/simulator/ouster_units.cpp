#include "tools/simulator/ouster_units.hpp"

#include <array>
#include <cmath>

#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator::ouster {
namespace {

// The profiles are shared out so that each kind of packet comes from one sensor at least; numbers of columns
// too. Beam origins and lifts are what units of these families report.
constexpr std::array kUnits{
    Unit{.name = "os0-32",
         .prod_line = "OS-0-32-U1",
         .firmware = "v2.5.2",
         .beams = 32,
         .half_field_deg = 45.0,
         .azimuth_step_deg = 5.6,
         .beam_origin_mm = 27.67,
         .lift_mm = 36.18,
         .min_range_m = 0.3,
         .max_range_m = 75.0,
         .range_sigma_m = 0.015,
         .columns_per_turn = 2048,
         .profile = Profile::dual},
    Unit{.name = "os0-64",
         .prod_line = "OS-0-64",
         .firmware = "v2.5.2",
         .beams = 64,
         .half_field_deg = 45.0,
         .azimuth_step_deg = 5.6,
         .beam_origin_mm = 27.67,
         .lift_mm = 36.18,
         .min_range_m = 0.3,
         .max_range_m = 75.0,
         .range_sigma_m = 0.015},
    Unit{.name = "os0-128",
         .prod_line = "OS-0-128",
         .firmware = "v3.1.0",
         .beams = 128,
         .half_field_deg = 45.0,
         .azimuth_step_deg = 5.6,
         .beam_origin_mm = 27.116,
         .lift_mm = 38.195,
         .min_range_m = 0.3,
         .max_range_m = 75.0,
         .range_sigma_m = 0.015,
         .profile = Profile::low_rate},
    Unit{.name = "os1-16",
         .prod_line = "OS-1-16-A0",
         .firmware = "v1.13.0",
         .beams = 16,
         .half_field_deg = 16.6,
         .azimuth_step_deg = 2.1,
         .beam_origin_mm = 12.163,
         .lift_mm = 36.18,
         .min_range_m = 0.8,
         .max_range_m = 120.0,
         .range_sigma_m = 0.015,
         .profile = Profile::legacy,
         .flat_metadata = true,
         .sixty_four_rows = true},
    Unit{.name = "os1-32",
         .prod_line = "OS-1-32-U0",
         .firmware = "v2.5.2",
         .beams = 32,
         .half_field_deg = 22.5,
         .azimuth_step_deg = 2.8,
         .beam_origin_mm = 15.806,
         .lift_mm = 36.18,
         .min_range_m = 0.3,
         .max_range_m = 170.0,
         .range_sigma_m = 0.01,
         .columns_per_turn = 512},
    Unit{.name = "os1-64",
         .prod_line = "OS-1-64",
         .firmware = "v2.1.2",
         .beams = 64,
         .half_field_deg = 16.6,
         .azimuth_step_deg = 2.1,
         .beam_origin_mm = 12.163,
         .lift_mm = 36.18,
         .min_range_m = 0.8,
         .max_range_m = 120.0,
         .range_sigma_m = 0.015,
         .profile = Profile::legacy,
         .flat_metadata = true},
    Unit{.name = "os1-128",
         .prod_line = "OS-1-128",
         .firmware = "v3.2.0",
         .beams = 128,
         .half_field_deg = 22.5,
         .azimuth_step_deg = 2.8,
         .beam_origin_mm = 16.721,
         .lift_mm = 38.195,
         .min_range_m = 0.3,
         .max_range_m = 170.0,
         .range_sigma_m = 0.01,
         .profile = Profile::low_rate,
         .nmea_imu = true},
    Unit{.name = "os2-32",
         .prod_line = "OS-2-32-U0",
         .firmware = "v3.0.1",
         .beams = 32,
         .half_field_deg = 11.25,
         .azimuth_step_deg = 1.4,
         .beam_origin_mm = 13.762,
         .lift_mm = 74.296,
         .min_range_m = 1.0,
         .max_range_m = 240.0,
         .range_sigma_m = 0.025},
    Unit{.name = "os2-64",
         .prod_line = "OS-2-64",
         .firmware = "v2.5.2",
         .beams = 64,
         .half_field_deg = 11.25,
         .azimuth_step_deg = 1.4,
         .beam_origin_mm = 13.762,
         .lift_mm = 78.296,
         .min_range_m = 1.0,
         .max_range_m = 240.0,
         .range_sigma_m = 0.025,
         .columns_per_turn = 2048},
    Unit{.name = "os2-128",
         .prod_line = "OS-2-128",
         .firmware = "v3.1.0",
         .beams = 128,
         .half_field_deg = 11.25,
         .azimuth_step_deg = 1.4,
         .beam_origin_mm = 13.762,
         .lift_mm = 78.296,
         .min_range_m = 1.0,
         .max_range_m = 240.0,
         .range_sigma_m = 0.025,
         .profile = Profile::low_rate_dual_fusa},
};

/// A unit of the first generation, part 840-101396-03, as it reports its angles.
constexpr std::array<Beam, 64> kOs1_64{
    {{16.729, 3.073},  {16.118, 0.904},   {15.543, -1.261},  {14.995, -3.384},  {14.526, 3.048},
     {13.937, 0.9},    {13.381, -1.235},  {12.837, -3.335},  {12.378, 3.029},   {11.801, 0.915},
     {11.251, -1.2},   {10.704, -3.301},  {10.251, 3.026},   {9.693, 0.921},    {9.138, -1.179},
     {8.603, -3.268},  {8.149, 3.032},    {7.594, 0.933},    {7.049, -1.156},   {6.513, -3.23},
     {6.056, 3.028},   {5.504, 0.953},    {4.961, -1.131},   {4.419, -3.209},   {3.967, 3.059},
     {3.424, 0.976},   {2.881, -1.112},   {2.328, -3.182},   {1.88, 3.071},     {1.337, 0.99},
     {0.787, -1.087},  {0.239, -3.155},   {-0.205, 3.097},   {-0.756, 1.014},   {-1.39, -1.103},
     {-1.854, -3.133}, {-2.3, 3.118},     {-2.839, 1.035},   {-3.386, -1.039},  {-3.935, -3.116},
     {-4.391, 3.144},  {-4.929, 1.061},   {-5.472, -1.013},  {-6.028, -3.101},  {-6.471, 3.178},
     {-7.02, 1.092},   {-7.563, -0.993},  {-8.116, -3.089},  {-8.572, 3.217},   {-9.112, 1.125},
     {-9.66, -0.972},  {-10.227, -3.072}, {-10.687, 3.265},  {-11.226, 1.159},  {-11.777, -0.949},
     {-12.35, -3.066}, {-12.807, 3.321},  {-13.347, 1.204},  {-13.902, -0.921}, {-14.49, -3.055},
     {-14.968, 3.381}, {-15.504, 1.252},  {-16.078, -0.898}, {-16.679, -3.071}}};

double rounded(double angle_deg) { return std::round(100.0 * angle_deg) / 100.0; }

}  // namespace

std::span<const Unit> units() noexcept { return kUnits; }

std::vector<Beam> beams_of(const Unit& unit) {
  if (unit.name == "os1-64") return {kOs1_64.begin(), kOs1_64.end()};
  constexpr std::uint64_t kSeed = 31;
  constexpr double kColumns[] = {1.5, 0.5, -0.5, -1.5};
  const double spacing_deg = 2.0 * unit.half_field_deg / static_cast<double>(unit.beams - 1);
  std::vector<Beam> beams(unit.beams);
  for (std::size_t i = 0; i < unit.beams; ++i) {
    // As built, not as designed: up to a seventh of the spacing off, and a tenth of a degree aside.
    const std::uint64_t bits = mix_bits(kSeed + 1000 * unit.beams + i);
    const double up = 2.0 * to_unit(bits) - 1.0;
    const double aside = 2.0 * to_unit(mix_bits(bits)) - 1.0;
    beams[i] = {
        .altitude_deg = rounded(unit.half_field_deg - spacing_deg * (static_cast<double>(i) - up / 7.0)),
        .azimuth_deg = rounded(unit.azimuth_step_deg * kColumns[i % 4] + 0.1 * aside)};
  }
  return beams;
}

}  // namespace landfix::tools::simulator::ouster
