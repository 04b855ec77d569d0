// The CAN frames that landfix sends, as one table of data: the encoder, the decoder, config/landfix.dbc and
// the table in the README follow from it. In front of the signals of each frame lies its end-to-end
// protection.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ndt/localizer.hpp"
#include "platform/can_frame.hpp"
#include "platform/can_signal.hpp"
#include "platform/e2e.hpp"

namespace landfix::platform {

struct FrameLayout {
  std::uint16_t id_offset = 0;  ///< from the configured base id
  std::string_view name;
  bool fd = false;              ///< CAN FD, protected by profile 5; else classic CAN, by profile 11C
  std::uint16_t period_ms = 0;  ///< 0: once a pose
  std::string_view meaning{};
  std::span<const Signal> signals{};

  [[nodiscard]] constexpr std::uint8_t length() const noexcept { return fd ? kMaxFdBytes : kMaxClassicBytes; }
  [[nodiscard]] constexpr E2eProfile profile() const noexcept {
    return fd ? E2eProfile::p05 : E2eProfile::p11c;
  }
  /// Identifies the frame to its end-to-end protection, wherever the base id is.
  [[nodiscard]] constexpr std::uint16_t data_id() const noexcept {
    return static_cast<std::uint16_t>(0x101 + id_offset);
  }
};

namespace pose_frame_table {

inline constexpr std::span<const std::string_view> kStates = ndt::kStateNames;
inline constexpr std::array<std::string_view, 2> kTimeSources{"SENSOR_CLOCK", "RECEIPT"};
inline constexpr std::array<std::string_view, 2> kNoYes{"NO", "YES"};
inline constexpr std::array<std::string_view, 6> kProjectors{
    "UNKNOWN", "LOCAL", "MGRS", "LOCAL_CARTESIAN_UTM", "LOCAL_CARTESIAN", "TRANSVERSE_MERCATOR"};
inline constexpr std::array<std::string_view, 3> kDatums{"UNKNOWN", "WGS84", "EGM2008"};

inline constexpr std::string_view kMapX = "rear axle centre on the ground, map x from the map's origin";
inline constexpr std::string_view kMapY = "rear axle centre on the ground, map y from the map's origin";
inline constexpr std::string_view kMapZ = "rear axle centre on the ground, map z from the map's origin";
inline constexpr std::string_view kYaw = "heading, counter-clockwise from the map's x axis (ISO 8855)";
inline constexpr std::string_view kPitch = "positive: nose down (ISO 8855)";
inline constexpr std::string_view kRoll = "positive: left side up (ISO 8855)";
inline constexpr std::string_view kSpeedX = "speed forward";
inline constexpr std::string_view kYawRate = "turn rate, positive: to the left";
inline constexpr std::string_view kSigmaAlong = "1 sigma along the heading";
inline constexpr std::string_view kSigmaCross = "1 sigma across the heading";
inline constexpr std::string_view kSigmaYaw = "1 sigma of the yaw";
inline constexpr std::string_view kState = "how far the pose is to be trusted";
inline constexpr std::string_view kTimeSource = "clock that the time comes from";
inline constexpr std::string_view kSaturated = "a value of this pose is beyond its signal's range";
inline constexpr std::string_view kScore = "match score: share of the best likelihood that the map allows";
inline constexpr std::string_view kIterations = "iterations of the match";
inline constexpr std::string_view kAge = "time of sending minus the last sweep's last point";

using R = PoseReport;

inline constexpr std::array kPosition{
    Signal{"LOC_X", &R::x_m, signed_at(16, 24), 1e-3, "m", kMapX},
    Signal{"LOC_Y", &R::y_m, signed_at(40, 24), 1e-3, "m", kMapY},
};
inline constexpr std::array kAttitude{
    Signal{"LOC_YAW", &R::yaw_rad, signed_at(16, 16), 1e-4, "rad", kYaw},
    Signal{"LOC_PITCH", &R::pitch_rad, signed_at(32, 16), 1e-4, "rad", kPitch},
    Signal{"LOC_ROLL", &R::roll_rad, signed_at(48, 16), 1e-4, "rad", kRoll},
};
inline constexpr std::array kVelocity{
    Signal{"LOC_VX", &R::speed_x_mps, signed_at(16, 16), 5e-3, "m/s", kSpeedX},
    Signal{"LOC_YAW_RATE", &R::yaw_rate_radps, signed_at(32, 16), 1e-3, "rad/s", kYawRate},
    Signal{"LOC_Z", &R::z_m, signed_at(48, 16), 1e-2, "m", kMapZ},
};
inline constexpr std::array kAccuracy{
    Signal{"LOC_SIGMA_ALONG", &R::sigma_along_m, unsigned_at(16, 16), 1e-3, "m", kSigmaAlong},
    Signal{"LOC_SIGMA_CROSS", &R::sigma_cross_m, unsigned_at(32, 16), 1e-3, "m", kSigmaCross},
    Signal{"LOC_SIGMA_YAW", &R::sigma_yaw_rad, unsigned_at(48, 16), 1e-4, "rad", kSigmaYaw},
};
inline constexpr std::array kStatus{
    Signal{"LOC_STATE", &R::state, unsigned_at(16, 4), 1.0, "", kState, kStates},
    Signal{"LOC_TIME_SOURCE", &R::time_source, unsigned_at(20, 2), 1.0, "", kTimeSource, kTimeSources},
    Signal{"LOC_SATURATED", &R::saturated, unsigned_at(22, 1), 1.0, "", kSaturated, kNoYes},
    Signal{"LOC_PARTIAL_SWEEP", &R::partial_sweep, unsigned_at(23, 1), 1.0, "", "the sweep was no whole turn",
           kNoYes},
    Signal{"LOC_WEAK_AXES", &R::weak_axes, unsigned_at(24, 6), 1.0, "",
           "directions that the map does not hold, a bit each from bit 0: longitudinal, lateral, vertical, "
           "roll, pitch, yaw"},
    Signal{"LOC_SCORE", &R::score, unsigned_at(32, 8), 4e-3, "", kScore},
    Signal{"LOC_ITERATIONS", &R::iterations, unsigned_at(40, 8), 1.0, "", kIterations},
    Signal{"LOC_AGE", &R::age_s, unsigned_at(48, 16), 1e-4, "s", kAge},
};
inline constexpr std::array kTime{
    Signal{"LOC_STAMP", &R::stamp_utc_ns, unsigned_at(16, 48), 1e-5, "s",
           "time that the pose holds for, since 1970-01-01 UTC without leap seconds"},
};
/// As NovAtel's receivers give it: 0.04 mm.
inline constexpr double kGeodeticStep_deg = 180.0 / static_cast<double>(std::int64_t{1} << 39);
inline constexpr std::array kLatitude{
    Signal{"LOC_LATITUDE", &R::latitude_deg, signed_at(16, 40), kGeodeticStep_deg, "deg",
           "of the rear axle centre on WGS84, positive: north"},
    Signal{"LOC_UTM_ZONE", &R::utm_zone, unsigned_at(56, 8), 1.0, "",
           "that the map is projected by, 1 to 60; 0: by none"},
};
inline constexpr std::array kLongitude{
    Signal{"LOC_LONGITUDE", &R::longitude_deg, signed_at(16, 40), kGeodeticStep_deg, "deg",
           "of the rear axle centre on WGS84, positive: east"},
    Signal{"LOC_GEODETIC_STATE", &R::state, unsigned_at(56, 8), 1.0, "", kState, kStates},
};
inline constexpr std::array kMap{
    Signal{"LOC_MAP_HASH", &R::map_hash, unsigned_at(16, 16), 1.0, "", "tells one map from another"},
    Signal{"LOC_MAP_ORIGIN", &R::map_origin, unsigned_at(32, 8), 1.0, "",
           "which of the map's origins positions are relative to: in steps of 8000 m, bits 0 to 3 along x, 4 "
           "to 7 "
           "along y"},
    Signal{"LOC_MAP_PROJECTOR", &R::map_projector, unsigned_at(40, 8), 1.0, "",
           "how the map's x and y come from latitude and longitude", kProjectors},
    Signal{"LOC_MAP_DATUM", &R::map_datum, unsigned_at(48, 8), 1.0, "", "what heights are above", kDatums},
    Signal{"LOC_FRAMES_VERSION", &R::frames_version, unsigned_at(56, 8), 1.0, "",
           "of the layout of these frames"},
};
inline constexpr std::array kPose{
    Signal{"LOC_STAMP", &R::stamp_utc_ns, unsigned_at(24, 64), 1e-9, "s", kTime[0].meaning},
    Signal{"LOC_X", &R::x_m, signed_at(88, 32), 1e-4, "m", kMapX},
    Signal{"LOC_Y", &R::y_m, signed_at(120, 32), 1e-4, "m", kMapY},
    Signal{"LOC_Z", &R::z_m, signed_at(152, 32), 1e-4, "m", kMapZ},
    Signal{"LOC_ROLL", &R::roll_rad, signed_at(184, 32), 1e-7, "rad", kRoll},
    Signal{"LOC_PITCH", &R::pitch_rad, signed_at(216, 32), 1e-7, "rad", kPitch},
    Signal{"LOC_YAW", &R::yaw_rad, signed_at(248, 32), 1e-7, "rad", kYaw},
    Signal{"LOC_VX", &R::speed_x_mps, signed_at(280, 16), 5e-3, "m/s", kSpeedX},
    Signal{"LOC_VY", &R::speed_y_mps, signed_at(296, 16), 5e-3, "m/s", "speed to the left"},
    Signal{"LOC_VZ", &R::speed_z_mps, signed_at(312, 16), 5e-3, "m/s", "speed upwards"},
    Signal{"LOC_ROLL_RATE", &R::roll_rate_radps, signed_at(328, 16), 1e-3, "rad/s", "about the x axis"},
    Signal{"LOC_PITCH_RATE", &R::pitch_rate_radps, signed_at(344, 16), 1e-3, "rad/s", "about the y axis"},
    Signal{"LOC_YAW_RATE", &R::yaw_rate_radps, signed_at(360, 16), 1e-3, "rad/s", kYawRate},
    Signal{"LOC_SIGMA_ALONG", &R::sigma_along_m, unsigned_at(376, 16), 1e-3, "m", kSigmaAlong},
    Signal{"LOC_SIGMA_CROSS", &R::sigma_cross_m, unsigned_at(392, 16), 1e-3, "m", kSigmaCross},
    Signal{"LOC_SIGMA_UP", &R::sigma_up_m, unsigned_at(408, 16), 1e-3, "m", "1 sigma of the height"},
    Signal{"LOC_SIGMA_ROLL", &R::sigma_roll_rad, unsigned_at(424, 16), 1e-4, "rad", "1 sigma of the roll"},
    Signal{"LOC_SIGMA_PITCH", &R::sigma_pitch_rad, unsigned_at(440, 16), 1e-4, "rad", "1 sigma of the pitch"},
    Signal{"LOC_SIGMA_YAW", &R::sigma_yaw_rad, unsigned_at(456, 16), 1e-4, "rad", kSigmaYaw},
    Signal{"LOC_STATE", &R::state, unsigned_at(472, 4), 1.0, "", kState, kStates},
    Signal{"LOC_TIME_SOURCE", &R::time_source, unsigned_at(476, 2), 1.0, "", kTimeSource, kTimeSources},
    Signal{"LOC_SATURATED", &R::saturated, unsigned_at(478, 1), 1.0, "", kSaturated, kNoYes},
    Signal{"LOC_WEAK", &R::weak, unsigned_at(479, 1), 1.0, "", "the map does not hold every direction",
           kNoYes},
    Signal{"LOC_ITERATIONS", &R::iterations, unsigned_at(480, 8), 1.0, "", kIterations},
    Signal{"LOC_SCORE", &R::score, unsigned_at(488, 8), 4e-3, "", kScore},
    Signal{"LOC_AGE", &R::age_s, unsigned_at(496, 16), 1e-4, "s", kAge},
};

}  // namespace pose_frame_table

/// The offsets are the indices.
inline constexpr std::array kFrameLayouts{
    FrameLayout{0, "LOC_POSITION", false, 0, "where", pose_frame_table::kPosition},
    FrameLayout{1, "LOC_ATTITUDE", false, 0, "which way round", pose_frame_table::kAttitude},
    FrameLayout{2, "LOC_VELOCITY", false, 0, "how fast; and how high", pose_frame_table::kVelocity},
    FrameLayout{3, "LOC_ACCURACY", false, 0, "how well that is known", pose_frame_table::kAccuracy},
    FrameLayout{4, "LOC_STATUS", false, 0, "what it is worth", pose_frame_table::kStatus},
    FrameLayout{5, "LOC_TIME", false, 0, "when it holds", pose_frame_table::kTime},
    FrameLayout{6, "LOC_GEODETIC_LAT", false, 100, "where on Earth, if the map tells",
                pose_frame_table::kLatitude},
    FrameLayout{7, "LOC_GEODETIC_LON", false, 100, "where on Earth, if the map tells",
                pose_frame_table::kLongitude},
    FrameLayout{8, "LOC_MAP", false, 1000, "in which map", pose_frame_table::kMap},
    FrameLayout{9, "LOC_POSE", true, 0, "all of it at once", pose_frame_table::kPose},
};
inline constexpr std::size_t kClassicPoseFrames = 6;
inline constexpr std::size_t kLatitudeFrameIndex = 6;
inline constexpr std::size_t kLongitudeFrameIndex = 7;
inline constexpr std::size_t kMapFrameIndex = 8;
inline constexpr std::size_t kFdPoseFrameIndex = 9;
inline constexpr std::uint16_t kFramesVersion = 1;

/// The frames that a pose is sent in.
[[nodiscard]] constexpr std::span<const FrameLayout> pose_layouts(bool fd) noexcept {
  return fd ? std::span(kFrameLayouts).subspan(kFdPoseFrameIndex, 1)
            : std::span(kFrameLayouts).first(kClassicPoseFrames);
}

/// The last frame of the block still has an 11-bit identifier.
inline constexpr std::uint32_t kMaxBaseId = 0x7FF - kFrameLayouts.back().id_offset;

/// Every bit has one meaning at most, and none of the protection's has another; what the arithmetic of
/// signals relies on holds.
[[nodiscard]] constexpr bool is_sound(const FrameLayout& layout) noexcept {
  std::array<bool, 8 * kMaxFdBytes> is_used{};
  std::fill_n(is_used.begin(), 8 * e2e_header_bytes(layout.profile()), true);
  for (const Signal& signal : layout.signals) {
    const Bits& bits = signal.bits;
    const bool is_number = std::holds_alternative<double PoseReport::*>(signal.field);
    if (bits.length == 0 || bits.length > (is_number ? 48 : 64) || (signal.is_code() && bits.length > 16)) {
      return false;
    }
    if (bits.start + bits.length > 8 * layout.length()) return false;
    for (std::size_t i = bits.start; i < std::size_t{bits.start} + bits.length; ++i) {
      if (is_used[i]) return false;
      is_used[i] = true;
    }
  }
  return true;
}
static_assert(std::all_of(kFrameLayouts.begin(), kFrameLayouts.end(), is_sound));

}  // namespace landfix::platform
