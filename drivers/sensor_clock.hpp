// From the sensor's clock to UTC: trusted where it is synchronised, anchored to the times of receipt where
// not.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/sweep.hpp"

namespace landfix::drivers {

/// What the time of a packet says about the clocks.
enum class ClockVerdict : std::uint8_t {
  continues,  ///< as was to be expected
  doubtful,   ///< far off: the packet is damaged, or the first after a clock was set; not to be used
  stepped,    ///< the second packet that says so: a clock was set, the times start anew
};

/// The time nearest to `near_ns`, not before 1970, that lies so long after a full hour.
[[nodiscard]] std::int64_t nearest_after_hour(std::int64_t after_hour_ns, std::int64_t near_ns) noexcept;

/// Takes the time of each packet by the sensor's clock and by the receiver's. A sensor that differs by more
/// than 10 s, and has not said where it has its time from, is not synchronised (it counts from power-up, or
/// from a date of its own): then its spacing is kept and its offset is the smallest (receive - sensor) seen,
/// the packet that was delayed least, which may grow by 100 ppm, the most that two crystals drift apart.
class SensorClock {
 public:
  /// Latest time that is handled, year 2099. Sums and differences of such times cannot overflow.
  static constexpr std::int64_t kLatestNs = 4'102'444'800'000'000'000;

  /// The time at which a clock that counts microseconds since the full hour shows `microseconds`, near the
  /// time that the next packet should have, or near its receipt where that would be a jump. A count somewhat
  /// over an hour, as some firmware sends it around the rollover, is taken as it is.
  [[nodiscard]] std::int64_t expand_top_of_hour(std::uint32_t microseconds,
                                                std::int64_t receive_utc_ns) const noexcept;

  /// Takes the times of the next packet.
  [[nodiscard]] ClockVerdict advance(std::int64_t sensor_ns, std::int64_t receive_utc_ns) noexcept;

  /// The sensor knows UTC (from satellites), and said so in a packet received then: it is synchronised,
  /// whatever the receiver's clock shows. True if the times of coming packets are others for it.
  [[nodiscard]] bool learn_utc(std::int64_t sensor_utc_ns, std::int64_t receive_utc_ns) noexcept;

  [[nodiscard]] std::int64_t to_utc_ns(std::int64_t sensor_ns) const noexcept {
    return sensor_ns + offset_ns_;
  }
  [[nodiscard]] TimeSource time_source() const noexcept {
    return synchronised_ ? TimeSource::sensor : TimeSource::receive;
  }

 private:
  /// What the sensor's clock should show for a packet received then.
  [[nodiscard]] std::int64_t expected_ns(std::int64_t receive_utc_ns) const noexcept;
  /// UTC as well as it is known without the packet's own time.
  [[nodiscard]] std::int64_t reference_ns(std::int64_t receive_utc_ns) const noexcept;
  /// Whether the time fits those before: no clock has been set in between.
  [[nodiscard]] bool continues(std::int64_t sensor_ns, std::int64_t receive_utc_ns) const noexcept;
  void start(std::int64_t sensor_ns, std::int64_t receive_utc_ns) noexcept;

  /// One packet by both clocks.
  struct Moment {
    std::int64_t sensor_ns = 0;
    std::int64_t receive_utc_ns = 0;
  };
  Moment last_;
  std::optional<Moment> doubtful_;
  std::int64_t offset_ns_ = 0;     ///< UTC - sensor; 0 where the sensor is synchronised
  std::int64_t reference_ns_ = 0;  ///< UTC by the sensor's satellites - receiver's clock; 0 while unknown
  bool started_ = false;
  bool synchronised_ = false;
};

}  // namespace landfix::drivers
