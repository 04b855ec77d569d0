// Puts the blocks of packets into sweeps: when each begins, whether it is whole, and on whose clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/packet_history.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/stream_counters.hpp"
#include "drivers/sweep.hpp"
#include "drivers/sweep_cutter.hpp"

namespace landfix::drivers {

/// What a packet says about its place among the others. Sensor times are the sensor's own clock.
struct PacketTiming {
  std::int64_t first_firing_ns = 0;       ///< sensor time of the packet's earliest firing
  std::int64_t receive_utc_ns = 0;        ///< when it was received
  std::int64_t duration_ns = 0;           ///< until the next packet's earliest firing
  std::int64_t turn_ns = 0;               ///< time of one turn at the present speed
  std::optional<std::uint32_t> sequence;  ///< counts packets, where the sensor does
};

/// A sweep is complete if it runs from cut to cut and no packet of it is missing. A packet that comes twice
/// is dropped; one that comes late joins its sweep while that is still being filled.
class SweepBuilder {
 public:
  explicit SweepBuilder(double cut_deg) noexcept : cutter_(cut_deg) {}

  [[nodiscard]] const SensorClock& clock() const noexcept { return clock_; }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return counters_; }
  /// See SweepCutter::cannot_be: to be asked before the packet is begun.
  [[nodiscard]] bool cannot_be(std::span<const std::uint16_t> azimuths_centideg) const noexcept {
    return cutter_.cannot_be(azimuths_centideg);
  }
  /// See SensorClock::learn_utc.
  void learn_utc(std::int64_t sensor_utc_ns, std::int64_t receive_utc_ns) noexcept;

  /// Begins a packet that has been found sound. `first_azimuth_centideg` is its first block's. Cuts where the
  /// turn has lasted too long (1.5 nominal turns) or a clock was set. Anything but `decoded`: the packet has
  /// come before, too late or from another time; nothing of it may be used.
  [[nodiscard]] DecodeStatus begin_packet(const PacketTiming& packet, std::uint16_t first_azimuth_centideg,
                                          SweepPair& sweeps) noexcept;

  /// Begins a block, cutting before it if its azimuth says so. Returns the time of its earliest firing since
  /// the start of the sweep [s], >= 0.
  [[nodiscard]] float begin_block(std::uint16_t azimuth_centideg, std::int64_t first_firing_ns,
                                  SweepPair& sweeps) noexcept;

  /// Whether the packet has completed a sweep.
  [[nodiscard]] bool has_cut() const noexcept { return has_cut_; }

  /// Hands over what there is of the current sweep, as partial. False if it has no points.
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept;

 private:
  [[nodiscard]] bool is_overtaken(const PacketTiming& packet) const noexcept;
  [[nodiscard]] DecodeStatus join_late(const PacketTiming& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] std::uint32_t lost_before(const PacketTiming& packet) noexcept;
  [[nodiscard]] bool is_dark_sector(std::int64_t late_ns, std::int64_t turn_ns) noexcept;
  [[nodiscard]] bool restarts(const PacketTiming& packet) const noexcept;
  void end_turn(SweepPair& sweeps) noexcept;
  void close(SweepPair& sweeps) noexcept;

  SensorClock clock_;
  StreamCounters counters_;
  PacketHistory history_;
  SweepCutter cutter_;
  std::int64_t sweep_start_ns_ = 0;
  std::int64_t newest_packet_ns_ = 0;
  std::optional<std::uint32_t> newest_sequence_;
  int newest_azimuth_centideg_ = 0;
  /// In time, where no packets came: the last long ones.
  struct Gap {
    std::int64_t start_ns = 0;
    std::int64_t length_ns = 0;
    int azimuth_centideg = 0;  ///< of the packet before it
  };
  std::array<Gap, 4> gaps_{};
  std::size_t next_gap_ = 0;
  bool started_ = false;
  bool open_ = false;         ///< the current sweep has begun
  bool lost_ = false;         ///< packets are missing before the block to come
  bool overtaken_ = false;    ///< the packet is older than one that came before it
  bool has_cut_ = false;      ///< in this packet
  bool utc_changed_ = false;  ///< the sensor has said what UTC is since the last packet
};

}  // namespace landfix::drivers
