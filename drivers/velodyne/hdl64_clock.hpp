// A clock for the HDL-64E S1, whose packets hold no time: its rotor, held to the times of receipt.
#pragma once

#include <cstdint>

namespace landfix::drivers::velodyne {

/// A network delivers unevenly, a rotor turns evenly. So each packet is placed whole packet periods after the
/// one before it, by how far the rotor has turned (which shows lost and repeated packets), and drawn slowly
/// to the time of receipt. Its zero is the first packet: it looks like a sensor that counts from power-up.
class Hdl64S1Clock {
 public:
  static constexpr std::int64_t kPacketNs = 384'000;

  /// Time of the first firing of a packet. `turn_ns`: time of one turn at the present speed.
  [[nodiscard]] std::int64_t take(std::uint16_t first_azimuth_centideg, std::int64_t turn_ns,
                                  std::int64_t receive_utc_ns) noexcept;

 private:
  bool started_ = false;
  std::uint16_t azimuth_centideg_ = 0;
  std::int64_t start_utc_ns_ = 0;
  std::int64_t newest_ns_ = 0;
};

}  // namespace landfix::drivers::velodyne
