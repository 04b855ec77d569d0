// Sine and cosine of whole hundredths of a degree, from tables small enough to stay in the cache.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace landfix::drivers {

struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

namespace detail {

/// Below 46 deg; exact to the last bit or nearly so.
constexpr SineCosine series(double angle_rad) noexcept {
  SineCosine sum{.sine = 0.0, .cosine = 0.0};
  double term = 1.0;  // angle^n / n!
  for (int n = 0; n < 24; n += 2) {
    const double sign = n % 4 == 0 ? 1.0 : -1.0;
    sum.cosine += sign * term;
    term *= angle_rad / (n + 1);
    sum.sine += sign * term;
    term *= angle_rad / (n + 2);
  }
  return sum;
}

/// Of whole degrees, 0 to 359: what is more than 45 deg is turned back by quarters.
constexpr SineCosine of_degrees(int degrees) noexcept {
  const int quarters = (degrees + 45) / 90;
  const SineCosine near = series((degrees - 90 * quarters) * (std::numbers::pi / 180.0));
  switch (quarters % 4) {
    case 0:
      return near;
    case 1:
      return {.sine = near.cosine, .cosine = -near.sine};
    case 2:
      return {.sine = -near.sine, .cosine = -near.cosine};
    default:
      return {.sine = -near.cosine, .cosine = near.sine};
  }
}

struct SineTables {
  std::array<SineCosine, 360> degrees{};
  std::array<SineCosine, 100> hundredths{};
};

constexpr SineTables sine_tables() noexcept {
  SineTables tables;
  for (std::size_t i = 0; i < tables.degrees.size(); ++i) tables.degrees[i] = of_degrees(static_cast<int>(i));
  for (std::size_t i = 0; i < tables.hundredths.size(); ++i) {
    tables.hundredths[i] = series(static_cast<double>(i) * (std::numbers::pi / 18000.0));
  }
  return tables;
}

inline constexpr SineTables kSineTables = sine_tables();

}  // namespace detail

/// `centideg`: 0 to 35999. As floats the same as std::sin and std::cos give (a test tries every azimuth), but
/// at the quarters, where these are right.
[[nodiscard]] inline SineCosine sine_cosine(std::uint16_t centideg) noexcept {
  const SineCosine& a = detail::kSineTables.degrees[centideg / 100U];
  const SineCosine& b = detail::kSineTables.hundredths[centideg % 100U];
  return {.sine = a.sine * b.cosine + a.cosine * b.sine, .cosine = a.cosine * b.cosine - a.sine * b.sine};
}

}  // namespace landfix::drivers
