// What a pixel of each UDP profile looks like: constants, from which the loop over pixels is made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace landfix::drivers::ouster {

/// Ranges lie in the low bits of a little-endian word at the pixel's start, and, of a second return, of the
/// word at `second_at`; reflectivity is a byte.
struct PixelLayout {
  std::size_t bytes = 0;
  std::uint32_t range_mask = 0;
  unsigned range_shift = 0;  ///< of the masked word, to millimetres
  std::size_t reflectivity_at = 0;
  std::size_t second_at = 0;  ///< second return, laid out like the first; 0: there is none

  [[nodiscard]] constexpr std::size_t returns() const noexcept { return second_at == 0 ? 1 : 2; }
};

/// In the order of kProfiles.
enum class Profile : std::uint8_t {
  legacy,
  single,
  dual,
  low_rate,
  low_rate_dual_fusa,
  low_rate_dual,
  single_zones,
  dual_zones,
  low_rate_zones,
  low_rate_window,
  five_words,
  single_colour,
  dual_colour,
};

/// Firmware up to 1.13 sends as many rows of 16 and 32 beams too, in its only profile, LEGACY.
inline constexpr std::size_t kRowsOfOldFirmware = 64;

struct ProfileRow {
  std::string_view name;  ///< `udp_profile_lidar` of the metadata
  PixelLayout pixel;
};

// 20 bits of range in LEGACY, 19 in the RNG19 profiles: the bit above is a flag there (+524 m, if it were
// taken for range). RNG15 counts 8 mm.
inline constexpr PixelLayout kLegacyPixel{.bytes = 12, .range_mask = 0xFFFFF, .reflectivity_at = 4};
inline constexpr PixelLayout kSinglePixel{.bytes = 12, .range_mask = 0x7FFFF, .reflectivity_at = 4};
inline constexpr PixelLayout kDualPixel{
    .bytes = 16, .range_mask = 0x7FFFF, .reflectivity_at = 3, .second_at = 4};
inline constexpr PixelLayout kLowRatePixel{
    .bytes = 4, .range_mask = 0x7FFF, .range_shift = 3, .reflectivity_at = 2};
inline constexpr PixelLayout kLowRateZonesPixel{
    .bytes = 8, .range_mask = 0x7FFF, .range_shift = 3, .reflectivity_at = 2};
inline constexpr PixelLayout kLowRateDualPixel{
    .bytes = 8, .range_mask = 0x7FFF, .range_shift = 3, .reflectivity_at = 2, .second_at = 4};
inline constexpr PixelLayout kSingleColourPixel{.bytes = 16, .range_mask = 0x7FFFF, .reflectivity_at = 3};
inline constexpr PixelLayout kFiveWordPixel{
    .bytes = 20, .range_mask = 0x7FFFF, .reflectivity_at = 3, .second_at = 4};

inline constexpr std::array<ProfileRow, 13> kProfiles{{
    {"LEGACY", kLegacyPixel},
    {"RNG19_RFL8_SIG16_NIR16", kSinglePixel},
    {"RNG19_RFL8_SIG16_NIR16_DUAL", kDualPixel},
    {"RNG15_RFL8_NIR8", kLowRatePixel},
    {"FUSA_RNG15_RFL8_NIR8_DUAL", kLowRateDualPixel},
    {"RNG15_RFL8_NIR8_DUAL", kLowRateDualPixel},
    {"RNG19_RFL8_SIG16_NIR16_ZONE16", kSinglePixel},
    {"RNG19_RFL8_SIG16_ZONE16_DUAL", kDualPixel},
    {"RNG15_RFL8_NIR8_ZONE16", kLowRateZonesPixel},
    {"RNG15_RFL8_WIN8", kLowRatePixel},
    {"FIVE_WORD_PIXEL", kFiveWordPixel},
    {"RNG19_RFL8_SIG16_NIR16_RGB16", kSingleColourPixel},
    {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", kFiveWordPixel},
}};

[[nodiscard]] constexpr const PixelLayout& pixel_of(Profile profile) noexcept {
  return kProfiles[static_cast<std::size_t>(profile)].pixel;
}

}  // namespace landfix::drivers::ouster
