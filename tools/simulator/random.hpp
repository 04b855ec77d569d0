// Random numbers by counter: a number depends on its seed, stream and index alone, so that neither the number
// of threads nor the order of their work changes a simulation. The mixing is SplitMix64's (Steele, Lea and
// Flood, "Fast splittable pseudorandom number generators", 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace landfix::tools::simulator {

/// What a number is drawn for; streams of one seed are independent of each other.
enum class RandomStream : std::uint64_t {
  world = 1,
  range_noise,
  dropout,
  network,
  survey,
  odometry,
  gnss,
  unit,
};

[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t bits) noexcept {
  bits += 0x9E3779B97F4A7C15;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EB;
  return bits ^ (bits >> 31);
}

[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, RandomStream stream,
                                                  std::uint64_t index) noexcept {
  return mix_bits(mix_bits(mix_bits(seed) ^ static_cast<std::uint64_t>(stream)) ^ index);
}

/// Uniform in [0, 1).
[[nodiscard]] constexpr double to_unit(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Standard normal (Box and Muller).
[[nodiscard]] inline double to_normal(std::uint64_t bits) noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - to_unit(bits)));
  return radius * std::cos(2.0 * std::numbers::pi * to_unit(mix_bits(bits)));
}

/// The numbers of one stream, one after the other.
class Random {
 public:
  constexpr Random(std::uint64_t seed, RandomStream stream) noexcept : seed_(seed), stream_(stream) {}

  [[nodiscard]] double uniform(double low, double high) noexcept {
    return low + (high - low) * to_unit(next());
  }
  [[nodiscard]] double normal() noexcept { return to_normal(next()); }
  [[nodiscard]] bool chance(double probability) noexcept { return to_unit(next()) < probability; }

 private:
  [[nodiscard]] std::uint64_t next() noexcept { return random_bits(seed_, stream_, index_++); }

  std::uint64_t seed_;
  RandomStream stream_;
  std::uint64_t index_ = 0;
};

}  // namespace landfix::tools::simulator
