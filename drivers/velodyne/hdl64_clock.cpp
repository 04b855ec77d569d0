#include "drivers/velodyne/hdl64_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/sensor_clock.hpp"
#include "drivers/sweep_cutter.hpp"

namespace landfix::drivers::velodyne {
namespace {

/// Beyond this the receiver's clock was set, or the sensor was off.
constexpr std::int64_t kAnewNs = 100'000'000;
/// The share of its error by which the clock is drawn on, and the most at once, which is no lost packet.
constexpr std::int64_t kShare = 64;
constexpr std::int64_t kMostNs = Hdl64S1Clock::kPacketNs / 16;

}  // namespace

std::int64_t Hdl64S1Clock::take(std::uint16_t first_azimuth_centideg, std::int64_t turn_ns,
                                std::int64_t receive_utc_ns) noexcept {
  // Receive times come from captures: nothing is said about them.
  const std::int64_t received_ns = std::clamp<std::int64_t>(receive_utc_ns, 0, SensorClock::kLatestNs);
  if (!started_) {
    started_ = true;
    start_utc_ns_ = received_ns;
    azimuth_centideg_ = first_azimuth_centideg;
    return 0;
  }
  const std::int64_t by_receipt_ns = received_ns - start_utc_ns_;
  const std::int64_t elapsed_ns = by_receipt_ns - newest_ns_;
  if (std::abs(elapsed_ns) > kAnewNs) {
    azimuth_centideg_ = first_azimuth_centideg;
    newest_ns_ = by_receipt_ns;
    return newest_ns_;
  }
  // Turned since the newest packet, to within whole turns, of which those are taken that fit the receipt.
  const int step_centideg = turned_centideg(azimuth_centideg_, first_azimuth_centideg);
  const double step_ns = static_cast<double>(step_centideg) / kTurnCentideg * static_cast<double>(turn_ns);
  const double turns = std::round((static_cast<double>(elapsed_ns) - step_ns) / static_cast<double>(turn_ns));
  const std::int64_t packets =
      std::llround((step_ns + turns * static_cast<double>(turn_ns)) / static_cast<double>(kPacketNs));
  const std::int64_t time_ns = newest_ns_ + packets * kPacketNs;
  if (packets <= 0) return time_ns;  // comes again, or was overtaken
  azimuth_centideg_ = first_azimuth_centideg;
  newest_ns_ = time_ns + std::clamp((by_receipt_ns - time_ns) / kShare, -kMostNs, kMostNs);
  return newest_ns_;
}

}  // namespace landfix::drivers::velodyne
