// One frame of classic CAN or CAN FD, and where frames go.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace landfix::platform {

inline constexpr std::size_t kMaxClassicBytes = 8;
inline constexpr std::size_t kMaxFdBytes = 64;

struct CanFrame {
  std::uint32_t id = 0;          ///< 11 bits, or 29 if `extended`
  bool extended = false;         ///< the 29-bit format
  bool fd = false;               ///< CAN FD: up to 64 bytes
  bool bit_rate_switch = false;  ///< its data at the faster bit rate; CAN FD alone
  std::uint8_t length = 0;       ///< bytes; above 8 not every length exists (is_can_length)
  std::array<std::byte, kMaxFdBytes> data{};

  [[nodiscard]] std::span<const std::byte> payload() const noexcept {
    return std::span(data).first(std::min<std::size_t>(length, data.size()));
  }
  [[nodiscard]] bool operator==(const CanFrame&) const = default;
};

struct StampedFrame {
  std::int64_t stamp_utc_ns = 0;  ///< when it was received
  CanFrame frame{};
};

/// Whether a frame can have this many bytes (ISO 11898-1: beyond 8 the length code takes steps).
[[nodiscard]] constexpr bool is_can_length(std::size_t bytes, bool fd) noexcept {
  if (bytes <= kMaxClassicBytes) return true;
  constexpr std::array<std::size_t, 7> kLongLengths{12, 16, 20, 24, 32, 48, 64};
  return fd && std::find(kLongLengths.begin(), kLongLengths.end(), bytes) != kLongLengths.end();
}

/// Where frames come from: an interface of the kernel, or a log in its place.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// The next frame, if one has come by `now_utc_ns`. Never waits.
  [[nodiscard]] virtual bool next(StampedFrame& frame, std::int64_t now_utc_ns) noexcept = 0;
  /// To be called every 100 ms or more often: what the source has to see to. Never waits.
  virtual void maintain(std::int64_t /*monotonic_ns*/) noexcept {}
};

/// Frames of a log, each when its time has come.
class FrameLog final : public FrameSource {
 public:
  /// `frames`, in the order of their times, must outlive it.
  explicit FrameLog(std::span<const StampedFrame> frames) noexcept : frames_(frames) {}

  [[nodiscard]] bool next(StampedFrame& frame, std::int64_t now_utc_ns) noexcept override {
    if (frames_.empty() || frames_.front().stamp_utc_ns > now_utc_ns) return false;
    frame = frames_.front();
    frames_ = frames_.subspan(1);
    return true;
  }

 private:
  std::span<const StampedFrame> frames_;
};

/// The seam between the poses and the bus: an interface of the kernel, a log, a test.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// Frames that belong together, in their order. Never waits; how many were taken, the first ones: the rest
  /// is dropped. `stamp_utc_ns`: when they are sent.
  [[nodiscard]] virtual std::size_t send(std::span<const CanFrame> group,
                                         std::int64_t stamp_utc_ns) noexcept = 0;

  /// To be called before each group, and every 100 ms where there is none: what the sink has to see to. Never
  /// waits.
  virtual void maintain(std::int64_t /*monotonic_ns*/) noexcept {}
};

}  // namespace landfix::platform
