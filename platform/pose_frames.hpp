// Poses into CAN frames: packed, counted and protected, as pose_frame_table.hpp lays them out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/can_frame.hpp"
#include "platform/pose_frame_table.hpp"
#include "platform/pose_report.hpp"

namespace landfix::platform {

/// `counter`: of the layout's profile. Values that do not fit are clamped.
[[nodiscard]] CanFrame encode_frame(const FrameLayout& layout, std::uint32_t base_id, std::uint8_t counter,
                                    const PoseReport& report) noexcept;

/// Takes the layout's signals out of a frame of its length, unchecked.
void decode_frame(const FrameLayout& layout, std::span<const std::byte> payload, PoseReport& report) noexcept;

/// What is sent for one pose, in this order.
struct PoseFrames {
  std::array<CanFrame, kClassicPoseFrames + 3> frames{};
  std::size_t count = 0;
  bool saturated = false;  ///< a value was beyond what its signal can hold

  [[nodiscard]] std::span<const CanFrame> all() const& noexcept { return std::span(frames).first(count); }
  /// The frames would be gone.
  [[nodiscard]] std::span<const CanFrame> all() const&& noexcept = delete;
};

/// Counts on from pose to pose: the frames of one pose share one counter. Latitude and longitude, ten times a
/// second, share another, and LOC_MAP, once a second, has its own.
class PoseFrameEncoder {
 public:
  /// `fd`: each pose is one frame of CAN FD instead of six of classic CAN. `is_geodetic`: latitude and
  /// longitude are sent; they are not available where the position is not.
  PoseFrameEncoder(std::uint32_t base_id, bool fd, bool is_geodetic = false) noexcept
      : base_id_(base_id), fd_(fd), is_geodetic_(is_geodetic) {}

  [[nodiscard]] PoseFrames encode(const PoseReport& report) noexcept;

 private:
  /// Frames that are not sent with every pose.
  struct Slower {
    std::uint8_t counter = 0;
    std::optional<std::int64_t> sent_utc_ns{};
  };
  /// Those of the layouts, one counter for all, if they are due.
  void add_slower(std::span<const FrameLayout> layouts, const PoseReport& report, Slower& slower,
                  PoseFrames& result) const noexcept;

  std::uint32_t base_id_;
  bool fd_;
  bool is_geodetic_;
  std::uint8_t counter_ = 0;
  Slower geodetic_;
  Slower map_;
};

}  // namespace landfix::platform
