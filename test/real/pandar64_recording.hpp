// The Pandar64's recorded packets, decoded with the selection of the reference.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/hesai/calibration.hpp"
#include "drivers/hesai/pandar_decoder.hpp"
#include "drivers/little_endian.hpp"
#include "real/cloud_comparison.hpp"

namespace landfix::test::pandar64 {

using drivers::Beam;
using drivers::DecoderOptions;
using drivers::find_sensor_model;
using drivers::kSlotBytes;
using drivers::load_little_endian;
using drivers::Point;
using drivers::hesai::kPandar64;
using drivers::hesai::PandarLayout;

inline constexpr std::size_t kPandar64Lasers = 64;
inline constexpr std::size_t kBlocks = 6;
inline constexpr double kUnitM = 0.004;

/// The reference cuts channel by channel, where block azimuth + offset passes 0. Sweep 0 is what the channels
/// send that have not passed it when the recording begins.
class ChannelCutter {
 public:
  explicit ChannelCutter(std::span<const Beam> beams) : beams_(beams) {}

  int sweep_of(std::size_t channel, double block_azimuth_deg) {
    const double azimuth_deg =
        std::fmod(block_azimuth_deg + beams_[channel].azimuth_offset_deg + 360.0, 360.0);
    State& state = states_[channel];
    if (!state.started) state.sweep = azimuth_deg < 180.0 ? 1 : 0;
    if (state.started && azimuth_deg < state.azimuth_deg - 180.0) ++state.sweep;
    state.started = true;
    state.azimuth_deg = azimuth_deg;
    return state.sweep;
  }

 private:
  struct State {
    bool started = false;
    int sweep = 0;
    double azimuth_deg = 0.0;
  };
  std::span<const Beam> beams_;
  std::array<State, kPandar64Lasers> states_{};
};

/// Where a return that the reference kept stands in its order: by firing, channel, block.
struct Kept {
  int sweep = 0;
  std::size_t firing = 0;  ///< since the start of the recording
  std::size_t channel = 0;
  std::size_t block = 0;

  [[nodiscard]] auto order() const { return std::tuple(firing, channel, block); }
};

/// Blanks the returns that the reference leaves out: ranges outside 0.3 m to 200 m, and the first of a pair
/// that is less than 0.1 m from the second. Appends what is left, in the order of the packet.
inline void select_as_the_reference(RecordedPacket& packet, std::size_t packet_index, ChannelCutter& cutter,
                                    std::vector<Kept>& kept) {
  const auto slot_at = [&](std::size_t block, std::size_t channel) {
    return packet.payload.data() + 8 + block * 194 + 2 + channel * kSlotBytes;
  };
  const auto raw = [&](std::size_t block, std::size_t channel) {
    return load_little_endian<std::uint16_t>(slot_at(block, channel));
  };
  const auto in_range = [&](double range_m) { return range_m >= 0.3 && range_m <= 200.0; };
  for (std::size_t pair = 0; pair < kBlocks; pair += 2) {
    const double azimuth_deg = 0.01 * load_little_endian<std::uint16_t>(slot_at(pair, 0) - 2);
    std::array<int, kPandar64Lasers> sweep{};
    for (std::size_t c = 0; c < kPandar64Lasers; ++c) {
      sweep[c] = cutter.sweep_of(c, azimuth_deg);
      const double first_m = raw(pair, c) * kUnitM;
      const double second_m = raw(pair + 1, c) * kUnitM;
      const bool one_echo = in_range(second_m) && std::abs(first_m - second_m) < 0.1;
      if (one_echo || !in_range(first_m)) std::memset(slot_at(pair, c), 0, 2);
      if (!in_range(second_m)) std::memset(slot_at(pair + 1, c), 0, 2);
    }
    for (const std::size_t block : {pair, pair + 1}) {
      for (std::size_t c = 0; c < kPandar64Lasers; ++c) {
        if (raw(block, c) != 0) kept.push_back({sweep[c], packet_index * 3 + pair / 2, c, block});
      }
    }
  }
}

struct Decoded {
  std::vector<Point> points;  ///< of the whole recording
  std::vector<Kept> kept;     ///< parallel
};

inline Decoded decode(const std::filesystem::path& capture, std::span<const Beam> beams,
                      const DecoderOptions& options, const PandarLayout& layout = kPandar64) {
  DecoderBench bench(drivers::AnyDecoder(drivers::hesai::PandarDecoder(layout, beams, options)),
                     find_sensor_model("pandar64")->max_points_per_sweep());
  ChannelCutter cutter(beams);
  Decoded decoded;
  auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), 2400U);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    select_as_the_reference(packets[i], i, cutter, decoded.kept);
  }
  decode_all(bench, packets);
  decoded.points = bench.all_points();
  return decoded;
}

[[nodiscard]] inline std::vector<Beam> unit_beams(const std::filesystem::path& calibration) {
  return drivers::hesai::parse_calibration(platform::read_file(calibration), calibration.string(),
                                           find_sensor_model("pandar64")->beams);
}

}  // namespace landfix::test::pandar64
