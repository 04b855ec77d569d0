// CAN frames back into poses, each frame's protection checked. A pose comes out only whole: every one of its
// frames sound, new and of one counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "platform/can_frame.hpp"
#include "platform/e2e.hpp"
#include "platform/pose_frame_table.hpp"
#include "platform/pose_report.hpp"

namespace landfix::platform {

/// What came of one frame.
struct DecodedFrame {
  const FrameLayout* layout = nullptr;  ///< nothing: not one of ours
  E2eCheck check{};                     ///< wrong_crc also where its format is not the layout's
  bool out_of_order = false;            ///< a frame that follows it was there before it
  std::size_t frames_missing = 0;       ///< of the pose before, which is given up
  std::int64_t silence_ns = 0;          ///< since the last pose frame, where that is longer than the time-out
  std::optional<PoseReport> pose{};     ///< that this frame completes
  /// Latitude, longitude, zone and state alone, when both frames are there.
  std::optional<PoseReport> geodetic{};

  /// Something is wrong on the bus.
  [[nodiscard]] bool has_fault() const noexcept {
    return layout != nullptr &&
           (check.status != E2eStatus::ok || out_of_order || frames_missing != 0 || silence_ns != 0);
  }
};

class PoseFrameDecoder {
 public:
  /// Even an idle sender says its status twice a second.
  static constexpr std::int64_t kTimeout_ns = 500'000'000;
  /// A pose's frames follow each other at once. At 100 poses a second a counter comes again after 150 ms:
  /// what has waited for longer than this is not of the same pose, whatever its counter says.
  static constexpr std::int64_t kLongestPose_ns = 100'000'000;

  explicit PoseFrameDecoder(std::uint32_t base_id) noexcept;

  /// Of the frame with this identifier; nothing if it is not one of ours.
  [[nodiscard]] const FrameLayout* layout_of(const CanFrame& frame) const noexcept;

  /// Frames in the order of the bus. `stamp_utc_ns`: of receipt.
  [[nodiscard]] DecodedFrame decode(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept;

  /// Of the pose that is begun, at the end of the frames: 0 if none is.
  [[nodiscard]] std::size_t frames_missing() const noexcept;

 private:
  /// What comes less often than poses; false: it is not one of those.
  [[nodiscard]] bool take_slower(std::size_t index, const CanFrame& frame, DecodedFrame& result) noexcept;
  [[nodiscard]] bool is_between(std::size_t index, std::uint8_t counter,
                                std::int64_t stamp_utc_ns) const noexcept;
  void add_to_pose(std::size_t index, const CanFrame& frame, std::int64_t stamp_utc_ns,
                   DecodedFrame& result) noexcept;
  [[nodiscard]] bool has(std::size_t index) const noexcept { return (seen_ >> index & 1U) != 0; }

  std::uint32_t base_id_;
  std::array<E2eChecker, kFrameLayouts.size()> checkers_{};
  std::optional<std::int64_t> last_utc_ns_;  ///< receipt of the last accepted pose frame

  PoseReport geodetic_;
  std::optional<std::uint8_t> latitude_counter_;  ///< of the latitude that waits for its longitude

  // The pose that is begun, of classic frames.
  PoseReport report_;
  PoseReport map_;  ///< the last LOC_MAP
  std::uint8_t counter_ = 0;
  std::int64_t begun_utc_ns_ = 0;
  unsigned seen_ = 0;  ///< a bit for each of its frames that is there
};

}  // namespace landfix::platform
