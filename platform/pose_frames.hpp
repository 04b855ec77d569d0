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
  std::array<CanFrame, kClassicPoseFrames + 1> frames{};
  std::size_t count = 0;
  bool saturated = false;  ///< a value was beyond what its signal can hold

  [[nodiscard]] std::span<const CanFrame> all() const& noexcept { return std::span(frames).first(count); }
  /// The frames would be gone.
  [[nodiscard]] std::span<const CanFrame> all() const&& noexcept = delete;
};

/// Counts on from pose to pose: the frames of one pose share one counter. LOC_MAP, once a second, has its
/// own.
class PoseFrameEncoder {
 public:
  /// `fd`: each pose is one frame of CAN FD instead of six of classic CAN.
  PoseFrameEncoder(std::uint32_t base_id, bool fd) noexcept : base_id_(base_id), fd_(fd) {}

  [[nodiscard]] PoseFrames encode(const PoseReport& report) noexcept;

 private:
  [[nodiscard]] bool is_map_due(std::int64_t stamp_utc_ns) const noexcept;

  std::uint32_t base_id_;
  bool fd_;
  std::uint8_t counter_ = 0;
  std::uint8_t map_counter_ = 0;
  std::optional<std::int64_t> map_sent_utc_ns_;
};

}  // namespace landfix::platform
