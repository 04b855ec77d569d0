// The CAN frames that landfix sends, as one table of data: the encoder, the decoder and whatever describes
// the frames to others follow from it. Signals are little-endian (Intel) fixed point; bytes 0 and 1 of a
// frame are its end-to-end protection.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ndt/pose.hpp"
#include "platform/can_frame.hpp"

namespace landfix::platform {

/// One raw value says "not available": the lowest if signed, the highest if not.
struct Signal {
  std::string_view name;
  std::uint8_t start_bit = 0;  ///< of the least significant bit
  std::uint8_t length_bits = 0;
  bool is_signed = false;
  double scale = 1.0;  ///< physical value of one step
  std::string_view unit{};
  std::string_view meaning{};
};

struct FrameLayout {
  std::uint16_t id_offset = 0;  ///< from the configured base id
  std::string_view name;
  std::span<const Signal> signals{};

  /// Identifies the frame to its end-to-end protection, wherever the base id is.
  [[nodiscard]] constexpr std::uint16_t data_id() const noexcept {
    return static_cast<std::uint16_t>(0x101 + id_offset);
  }
};

inline constexpr std::array kPositionSignals{
    Signal{.name = "LOC_X",
           .start_bit = 16,
           .length_bits = 24,
           .is_signed = true,
           .scale = 0.001,
           .unit = "m",
           .meaning = "rear axle centre on the ground, east of the map's origin"},
    Signal{.name = "LOC_Y",
           .start_bit = 40,
           .length_bits = 24,
           .is_signed = true,
           .scale = 0.001,
           .unit = "m",
           .meaning = "rear axle centre on the ground, north of the map's origin"},
};

inline constexpr std::array kAttitudeSignals{
    Signal{.name = "LOC_YAW",
           .start_bit = 16,
           .length_bits = 16,
           .is_signed = true,
           .scale = 1e-4,
           .unit = "rad",
           .meaning = "heading, counter-clockwise from the map's x axis (ISO 8855)"},
    Signal{.name = "LOC_PITCH",
           .start_bit = 32,
           .length_bits = 16,
           .is_signed = true,
           .scale = 1e-4,
           .unit = "rad",
           .meaning = "positive: nose down (ISO 8855)"},
    Signal{.name = "LOC_ROLL",
           .start_bit = 48,
           .length_bits = 16,
           .is_signed = true,
           .scale = 1e-4,
           .unit = "rad",
           .meaning = "positive: left side up (ISO 8855)"},
};

inline constexpr std::array kFrameLayouts{
    FrameLayout{.id_offset = 0, .name = "LOC_POSITION", .signals = kPositionSignals},
    FrameLayout{.id_offset = 1, .name = "LOC_ATTITUDE", .signals = kAttitudeSignals},
};
inline constexpr const FrameLayout& kPositionFrame = kFrameLayouts[0];
inline constexpr const FrameLayout& kAttitudeFrame = kFrameLayouts[1];

/// Rounds half to even and clamps, never wraps; NaN becomes "not available". True if it had to clamp.
bool encode_signal(const Signal& signal, double value, std::span<std::byte, 8> data) noexcept;
/// NaN if not available.
[[nodiscard]] double decode_signal(const Signal& signal, std::span<const std::byte, 8> data) noexcept;

struct EncodedFrame {
  CanFrame frame{};
  bool saturated = false;  ///< a value was beyond what its signal can hold
};

/// `values`: one for each of the layout's signals, in its unit. `counter`: 0 to 14.
[[nodiscard]] EncodedFrame encode_frame(const FrameLayout& layout, std::uint32_t base_id,
                                        std::uint8_t counter, std::span<const double> values) noexcept;

/// The frames of one pose, which share one counter.
struct PoseFrames {
  std::array<CanFrame, 2> frames{};
  bool saturated = false;
};

/// Counts on from pose to pose.
class PoseFrameEncoder {
 public:
  explicit PoseFrameEncoder(std::uint32_t base_id) noexcept : base_id_(base_id) {}

  /// `pose`: map <- vehicle, relative to the map's origin.
  [[nodiscard]] PoseFrames encode(const ndt::Pose& pose) noexcept;

 private:
  std::uint32_t base_id_;
  std::uint8_t counter_ = 0;
};

}  // namespace landfix::platform
