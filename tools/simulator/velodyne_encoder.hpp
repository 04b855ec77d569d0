// Velodyne's packets, written from the manual (VLP-16 User Manual 63-9243 Rev D, section 9).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tools/simulator/vlp16.hpp"

namespace landfix::tools::simulator {

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;
using DataPayload = std::array<std::byte, 1206>;
using PositionPayload = std::array<std::byte, 512>;

struct Vlp16Return {
  std::uint16_t distance_raw = 0;  ///< 2 mm; 0: no return
  std::uint8_t reflectivity_raw = 0;
};

/// What a data packet of the single-return mode holds.
struct Vlp16Firings {
  std::int64_t first_firing_utc_ns = 0;
  std::array<std::uint16_t, vlp16::kBlocks> azimuth_centideg_raw{};  ///< at each block's first firing
  std::array<Vlp16Return, vlp16::kFiringsPerPacket> returns{};
};

/// What the GPS receiver at the sensor says.
struct GpsFix {
  std::int64_t utc_ns = 0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double speed_mps = 0.0;
  double course_deg = 0.0;  ///< clockwise from north
};

[[nodiscard]] DataPayload encode_data(const Vlp16Firings& firings) noexcept;
/// With the clock locked to the receiver's pulse.
[[nodiscard]] PositionPayload encode_position(const GpsFix& fix);

}  // namespace landfix::tools::simulator
