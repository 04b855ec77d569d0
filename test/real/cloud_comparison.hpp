// How a decoded sweep differs from a reference cloud of the same returns in the same order.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/make_decoder.hpp"
#include "ndt/pcd.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcap_source.hpp"
#include "support/decoder_bench.hpp"

namespace landfix::test {

/// A point by what the laser measured.
struct Return {
  double range_m = 0.0;
  double height_m = 0.0;
  double azimuth_deg = 0.0;  ///< clockwise from the front
  double intensity = 0.0;
};

[[nodiscard]] inline Return to_return(double forward_m, double left_m, double up_m, double intensity) {
  return {.range_m = std::sqrt(forward_m * forward_m + left_m * left_m + up_m * up_m),
          .height_m = up_m,
          .azimuth_deg = -std::atan2(left_m, forward_m) * 180.0 / std::numbers::pi,
          .intensity = intensity};
}

[[nodiscard]] inline std::vector<Return> to_returns(std::span<const drivers::Point> points) {
  std::vector<Return> returns;
  for (const auto& p : points) {
    returns.push_back(to_return(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z),
                                static_cast<double>(p.intensity)));
  }
  return returns;
}

/// The angle between two azimuths, 0 to 180.
[[nodiscard]] inline double degrees_apart(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

/// Largest differences over two clouds of one size.
struct Differences {
  double range_m = 0.0;
  double height_m = 0.0;
  double azimuth_deg = 0.0;
  double azimuth_rms_deg = 0.0;
  double intensity = 0.0;
};

[[nodiscard]] inline Differences compare(std::span<const Return> ours, std::span<const Return> theirs) {
  Differences most;
  double squares = 0.0;
  const std::size_t count = std::min(ours.size(), theirs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth_deg = degrees_apart(ours[i].azimuth_deg, theirs[i].azimuth_deg);
    most.range_m = std::max(most.range_m, std::abs(ours[i].range_m - theirs[i].range_m));
    most.height_m = std::max(most.height_m, std::abs(ours[i].height_m - theirs[i].height_m));
    most.azimuth_deg = std::max(most.azimuth_deg, azimuth_deg);
    most.intensity = std::max(most.intensity, std::abs(ours[i].intensity - theirs[i].intensity));
    squares += azimuth_deg * azimuth_deg;
  }
  most.azimuth_rms_deg = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
  return most;
}

/// The values of `columns` of each point of a PCD file.
[[nodiscard]] inline std::vector<std::vector<double>> read_pcd(const std::filesystem::path& path,
                                                               std::span<const std::string_view> columns) {
  std::vector<std::vector<double>> rows;
  ndt::visit_pcd(platform::read_file(path), path.string(), columns, [&rows](std::span<const double> values) {
    rows.emplace_back(values.begin(), values.end());
  });
  return rows;
}

/// All data packets of a capture, in order, as they were received.
struct RecordedPacket {
  std::vector<std::byte> payload;
  std::int64_t receive_utc_ns = 0;

  [[nodiscard]] drivers::Packet view() const {
    return {.payload = payload, .receive_utc_ns = receive_utc_ns};
  }
};

[[nodiscard]] inline std::vector<RecordedPacket> read_packets(const std::filesystem::path& path,
                                                              std::uint16_t port) {
  platform::PcapSource source(path);
  platform::UdpPacket packet;
  std::vector<RecordedPacket> packets;
  while (source.next(packet) == platform::ReadStatus::packet) {
    if (packet.destination_port != port) continue;
    packets.push_back({{packet.payload.begin(), packet.payload.end()}, packet.receive_utc_ns});
  }
  return packets;
}

using SweepCopy = DecoderBench::SweepCopy;

/// Decodes packets, of which none may be refused or missing, to the last point.
inline void decode_all(DecoderBench& bench, std::span<const RecordedPacket> packets) {
  for (const RecordedPacket& packet : packets) {
    const auto status = bench.decode(packet.payload, packet.receive_utc_ns).status;
    EXPECT_FALSE(drivers::is_rejected(status)) << to_string(status);
  }
  static_cast<void>(bench.flush());
  EXPECT_EQ(bench.counters().lost_packets, 0U);
}

/// With room for any sweep of the model.
[[nodiscard]] inline DecoderBench bench_of(std::string_view name, const drivers::DecoderOptions& options,
                                           const drivers::Calibration& calibration = {}) {
  return DecoderBench(name, options, drivers::find_sensor_model(name)->max_points_per_sweep(), calibration);
}

/// The sweeps of packets, whole and in order; the last one is what was left.
[[nodiscard]] inline std::vector<SweepCopy> decode_sweeps(std::string_view name,
                                                          std::span<const RecordedPacket> packets,
                                                          const drivers::DecoderOptions& options,
                                                          const drivers::Calibration& calibration = {}) {
  DecoderBench bench = bench_of(name, options, calibration);
  decode_all(bench, packets);
  return bench.swept();
}

/// A cloud as the vendor's viewer writes it: right, forward, up, intensity.
[[nodiscard]] inline std::vector<drivers::Point> read_viewer_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // header
  std::vector<drivers::Point> points;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    float right_m = 0.0F;
    float forward_m = 0.0F;
    float up_m = 0.0F;
    float intensity = 0.0F;
    char comma = 0;
    row >> right_m >> comma >> forward_m >> comma >> up_m >> comma >> intensity;
    points.push_back({.x = forward_m, .y = -right_m, .z = up_m, .intensity = intensity});
  }
  return points;
}

/// On stdout, for the log.
inline void print(const char* what, const Differences& most) {
  std::cout << what << ", most: range " << most.range_m << " m, height " << most.height_m << " m, azimuth "
            << most.azimuth_deg << " deg, rms " << most.azimuth_rms_deg << " deg\n";
}

}  // namespace landfix::test
