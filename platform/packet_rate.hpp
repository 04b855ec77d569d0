// How many packets a sensor sends, and how many of them the ring between rx and solve holds.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>

#include "drivers/sensor_model.hpp"

namespace landfix::platform {

/// What the ring holds: longer than solve is ever busy with a sweep.
inline constexpr double kPacketRing_s = 0.25;

/// The most there are, with all returns.
[[nodiscard]] constexpr double packets_per_s(const drivers::SensorModel& model) noexcept {
  const double firings_per_s = 1e6 / model.firing_period_us;
  // A column with all its returns.
  constexpr double kColumnsOfOuster = 16.0;
  if (model.format == drivers::PacketFormat::ouster) return firings_per_s / kColumnsOfOuster;
  // Of both returns one firing a packet, which leaves four blocks empty.
  if (model.format == drivers::PacketFormat::velodyne_vls128 && model.max_returns == 2) return firings_per_s;
  // 12 blocks of 32 returns or as many in another order, of Pandar40P 10 blocks of 40.
  const double returns_of_packet = model.beam_count == 40 ? 400.0 : 384.0;
  return firings_per_s * static_cast<double>(model.beam_count) * model.max_returns / returns_of_packet;
}

[[nodiscard]] constexpr std::size_t largest_packet_bytes(const drivers::SensorModel& model) noexcept {
  return model.payload_sizes.empty()
             ? 0
             : *std::max_element(model.payload_sizes.begin(), model.payload_sizes.end());
}

/// A power of two.
[[nodiscard]] constexpr std::size_t packet_ring_slots(const drivers::SensorModel& model) noexcept {
  return std::bit_ceil(static_cast<std::size_t>(packets_per_s(model) * kPacketRing_s) + 1);
}

/// For the socket: as long as the ring. The kernel counts what a packet takes with its bookkeeping: twice.
[[nodiscard]] constexpr std::size_t receive_buffer_bytes(const drivers::SensorModel& model) noexcept {
  constexpr std::size_t kAtLeast = std::size_t{4} << 20;
  const double bytes =
      packets_per_s(model) * kPacketRing_s * static_cast<double>(largest_packet_bytes(model));
  return std::max(kAtLeast, static_cast<std::size_t>(2.0 * bytes));
}

}  // namespace landfix::platform
