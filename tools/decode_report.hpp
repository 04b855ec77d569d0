// What came of decoding a capture, for a person and for a program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/decoder.hpp"
#include "drivers/sensor_model.hpp"
#include "drivers/velodyne/position_packet.hpp"

namespace landfix::tools {

struct SweepSummary {
  std::size_t points = 0;
  std::size_t overflowed = 0;
  std::uint32_t lost_packets = 0;
  bool complete = false;
  drivers::TimeSource time_source{};
  double first_time_s = 0.0;  ///< Unix
  double last_time_s = 0.0;
};

struct DecodeSummary {
  drivers::StatusCounts packets{};
  std::uint64_t elsewhere = 0;  ///< packets to other ports
  drivers::StreamCounters stream;
  std::vector<SweepSummary> sweeps;
  std::optional<drivers::velodyne::PositionFix> position;  ///< the last that the receiver at the sensor had
  bool position_is_valid = false;                          ///< it still had it in the latest packet

  [[nodiscard]] std::uint64_t of(drivers::DecodeStatus status) const {
    return packets[static_cast<std::size_t>(status)];
  }
  [[nodiscard]] std::uint64_t decoded() const { return of(drivers::DecodeStatus::decoded); }
  /// Data packets that gave no points.
  [[nodiscard]] std::uint64_t rejected() const { return drivers::rejected(packets); }
};

/// Why packets were rejected, and how many for each reason.
[[nodiscard]] std::vector<std::pair<std::string_view, std::uint64_t>> rejections(
    const drivers::StatusCounts& packets);

/// "12 x its sweep has been handed over already, ...": why packets were rejected.
[[nodiscard]] std::string reasons(const DecodeSummary& summary);

/// As one JSON object on stdout.
void print_json(const drivers::SensorModel& model, const DecodeSummary& summary);
/// As lines of text on stdout.
void print_text(const drivers::SensorModel& model, const DecodeSummary& summary, const std::string& folder);

}  // namespace landfix::tools
