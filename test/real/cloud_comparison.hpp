// How a decoded sweep differs from a reference cloud of the same returns in the same order.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/make_decoder.hpp"
#include "ndt/pcd.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcap_source.hpp"

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

}  // namespace landfix::test
