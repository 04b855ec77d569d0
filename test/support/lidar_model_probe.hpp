// What a sensor of the simulator aims at and what it writes, for tests to look at: its fields are put
// together byte by byte, by nothing that the simulator writes them with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/calibration.hpp"
#include "tools/simulator/lidar_model.hpp"

namespace landfix::test {

/// 2026-05-04 08:00:00: there every rotor of the simulator looks to the front.
inline constexpr std::int64_t kFullHour_utc_ns = 1'777'881'600'000'000'000;

[[nodiscard]] inline std::vector<tools::simulator::Shot> shots_at(const tools::simulator::LidarModel& model,
                                                                  std::int64_t utc_ns) {
  std::vector<tools::simulator::Shot> shots(model.traits().shots_per_packet);
  model.aim(utc_ns, shots);
  return shots;
}

[[nodiscard]] inline std::vector<tools::simulator::Shot> shots_at(std::string_view model,
                                                                  std::int64_t utc_ns) {
  return shots_at(*tools::simulator::make_lidar_model(model), utc_ns);
}

/// Of the simulated unit, as its decoder takes it; nothing where the packets say it all.
[[nodiscard]] inline drivers::Calibration calibration_of(const tools::simulator::LidarModel& lidar) {
  const auto file = lidar.calibration();
  if (!file) return {};
  const drivers::SensorModel& model = *drivers::find_sensor_model(lidar.traits().name);
  return drivers::parse_calibration(model, std::as_bytes(std::span(file->text)), file->name);
}

[[nodiscard]] inline unsigned byte_at(std::span<const std::byte> payload, std::size_t at) {
  return std::to_integer<unsigned>(payload[at]);
}

/// `size` bytes, the most significant first.
[[nodiscard]] inline std::uint64_t big_at(std::span<const std::byte> payload, std::size_t at,
                                          std::size_t size) {
  std::uint64_t value = 0;
  for (const std::byte byte : payload.subspan(at, size)) value = value << 8 | std::to_integer<unsigned>(byte);
  return value;
}

/// `size` bytes, the least significant first.
[[nodiscard]] inline std::uint64_t little_at(std::span<const std::byte> payload, std::size_t at,
                                             std::size_t size) {
  std::uint64_t value = 0;
  while (size-- > 0) value = value << 8 | byte_at(payload, at + size);
  return value;
}

}  // namespace landfix::test
