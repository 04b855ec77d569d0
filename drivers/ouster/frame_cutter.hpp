// Puts packets into sweeps by their frame id: which belong together, when all of them are there, which come
// too late or twice, and what is missing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/decoder.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/stream_counters.hpp"
#include "drivers/sweep.hpp"

namespace landfix::drivers::ouster {

/// The packets of a frame, of one turn: number 0 begins where the encoder passes zero.
class PacketSet {
 public:
  void insert(std::size_t packet) noexcept { words_[packet / 64] |= bit(packet); }
  [[nodiscard]] bool contains(std::size_t packet) const noexcept {
    return packet < kMaxColumnsPerFrame && (words_[packet / 64] & bit(packet)) != 0;
  }
  [[nodiscard]] std::uint32_t size() const noexcept;
  /// How many from `first` on are in it but not in `other`.
  [[nodiscard]] std::uint32_t missing_in(const PacketSet& other, std::size_t first) const noexcept;

 private:
  [[nodiscard]] static constexpr std::uint64_t bit(std::size_t packet) noexcept {
    return std::uint64_t{1} << (packet % 64);
  }
  std::array<std::uint64_t, kMaxColumnsPerFrame / 64> words_{};
};

/// What a packet says about its place among the others.
struct FramePacket {
  std::uint32_t frame_id = 0;
  std::uint32_t init_id = 0;  ///< another after each start of the sensor; 0: not told
  std::size_t number = 0;     ///< within the frame
  /// Sensor time of the first column that holds anything, if one does.
  std::optional<std::int64_t> first_firing_ns;
  std::int64_t receive_utc_ns = 0;
};

/// A frame is handed over as soon as all packets of the sensor's column window are there, without waiting for
/// the next; otherwise, as partial, with the first packet of a newer one. Order within a frame does not
/// matter: a packet fills its own place. Frame ids are compared modulo their width; what an id says must fit
/// the time, or the sensor has restarted and counts anew.
class FrameCutter {
 public:
  explicit FrameCutter(const Metadata& metadata) noexcept;

  [[nodiscard]] const StreamCounters& counters() const noexcept { return counters_; }
  /// Whether the sensor sends this packet of a turn.
  [[nodiscard]] bool expects(std::size_t number) const noexcept { return expected_.contains(number); }

  /// Begins a packet that has been found sound, and that is expected. Anything but `decoded`: the packet has
  /// come before, too late or from another time; nothing of it may be used.
  [[nodiscard]] DecodeStatus begin_packet(const FramePacket& packet, SweepPair& sweeps) noexcept;

  /// Of a firing of the packet, since the start of the sweep [s], >= 0.
  [[nodiscard]] float time_of(std::int64_t firing_ns) const noexcept {
    return static_cast<float>(static_cast<double>(firing_ns - sweep_start_ns_) * 1e-9);
  }

  /// All points of the packet are in the sweep. True if it has completed a sweep.
  [[nodiscard]] bool end_packet(SweepPair& sweeps) noexcept;

  /// Hands over what there is of the current sweep. False if it has no points.
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept;

 private:
  enum class Place : std::uint8_t { same_frame, next_frame, restarted, duplicate, late };

  [[nodiscard]] Place place_of(const FramePacket& packet) const noexcept;
  [[nodiscard]] Place place_in_same_frame(const FramePacket& packet) const noexcept;
  [[nodiscard]] std::int32_t frames_ahead(std::uint32_t frame_id) const noexcept;
  /// Whether so many frames can have passed since the newest packet.
  [[nodiscard]] bool fits_time(std::int32_t frames, const FramePacket& packet) const noexcept;
  [[nodiscard]] ClockVerdict advance_clock(const FramePacket& packet, Place place) noexcept;
  void end_frame(const FramePacket& packet, Place place, SweepPair& sweeps) noexcept;
  void begin_frame(const FramePacket& packet, Place place) noexcept;
  void begin_sweep(const FramePacket& packet, bool stepped, SweepPair& sweeps) noexcept;
  void close(SweepPair& sweeps) noexcept;
  [[nodiscard]] bool is_complete() const noexcept { return received_count_ == expected_count_; }

  int frame_id_bits_;
  std::int64_t turn_ns_;
  PacketSet expected_;
  std::uint32_t expected_count_ = 0;

  SensorClock clock_;
  StreamCounters counters_;
  bool started_ = false;
  std::uint32_t refused_in_a_row_ = 0;  ///< duplicate or late

  // The frame that is being received.
  std::uint32_t frame_id_ = 0;
  std::uint32_t init_id_ = 0;
  PacketSet received_;
  std::uint32_t received_count_ = 0;
  std::size_t joined_at_ = 0;  ///< packets before it were sent before the stream began
  std::size_t newest_number_ = 0;
  std::int64_t newest_ns_ = 0;  ///< of this frame, if it is timed, or of the one before
  bool timed_ = false;          ///< a packet of it holds anything

  // Its sweep.
  bool open_ = false;     ///< the current sweep has begun
  bool torn_ = false;     ///< a part of the frame was handed over before its end
  bool has_cut_ = false;  ///< in this packet
  std::int64_t sweep_start_ns_ = 0;
};

}  // namespace landfix::drivers::ouster
