// The Pandar64's recorded packets against the cloud that another driver decoded from them.
#include <array>
#include <cstring>
#include <iostream>
#include <map>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/hesai/calibration.hpp"
#include "drivers/hesai/wire.hpp"
#include "drivers/little_endian.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using hesai::kPandar64Lasers;
using hesai::WireBlock;
using hesai::WireHeader;
using test::Differences;
using test::RecordedPacket;
using test::Return;

constexpr std::size_t kBlocks = 6;
constexpr double kUnitM = 0.004;

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
void select_as_the_reference(RecordedPacket& packet, std::size_t packet_index, ChannelCutter& cutter,
                             std::vector<Kept>& kept) {
  const auto slot_at = [&](std::size_t block, std::size_t channel) {
    return packet.payload.data() + sizeof(WireHeader) + block * sizeof(WireBlock) + 2 + channel * kSlotBytes;
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

Decoded decode(const std::filesystem::path& capture, std::span<const Beam> beams,
               const DecoderOptions& options) {
  const SensorModel& model = *find_sensor_model("pandar64");
  AnyDecoder decoder = make_decoder(model, options, std::vector<Beam>(beams.begin(), beams.end()));
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  SweepPair sweeps(storage);
  ChannelCutter cutter(beams);
  Decoded decoded;
  const auto keep = [&] {
    const auto points = sweeps.completed().points();
    decoded.points.insert(decoded.points.end(), points.begin(), points.end());
  };
  std::size_t index = 0;
  for (RecordedPacket& packet : test::read_packets(capture, 2368)) {
    select_as_the_reference(packet, index++, cutter, decoded.kept);
    const DecodeResult result = decoder.decode(packet.view(), sweeps);
    EXPECT_EQ(result.status, DecodeStatus::decoded);
    if (result.sweep_completed) keep();
  }
  EXPECT_EQ(index, 2400U);
  if (decoder.flush(sweeps)) keep();
  return decoded;
}

/// Our points of one of the reference's sweeps, in its order.
std::vector<Return> sweep_as_the_reference(const Decoded& decoded, int sweep) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < decoded.kept.size(); ++i) {
    if (decoded.kept[i].sweep == sweep) chosen.push_back(i);
  }
  std::ranges::sort(chosen, {}, [&](std::size_t i) { return decoded.kept[i].order(); });
  std::vector<Point> points;
  for (const std::size_t i : chosen) points.push_back(decoded.points.at(i));
  return test::to_returns(points);
}

/// The reference's axes: y forward, x right.
std::vector<Return> read_reference(const std::filesystem::path& path) {
  constexpr std::string_view kColumns[] = {"x", "y", "z"};
  std::vector<Return> returns;
  for (const auto& row : test::read_pcd(path, kColumns)) {
    returns.push_back(test::to_return(row[1], -row[0], row[2], 0.0));
  }
  return returns;
}

struct Case {
  const char* name;
  DecoderOptions options;
  double azimuth_deg;  ///< largest difference that is allowed
};

TEST(Pandar64RealData, AgreesWithTheReference) {
  LANDFIX_REAL_DATA(capture, "pandar64/capture.pcap");
  LANDFIX_REAL_DATA(reference, "pandar64/capture-sweep.pcd");
  LANDFIX_REAL_DATA(calibration, "pandar64/calibration.csv");
  const auto beams = hesai::parse_calibration(platform::read_file(calibration), calibration.string(),
                                              find_sensor_model("pandar64")->beams);
  const auto theirs = read_reference(reference);
  const Case cases[] = {
      // Without the two corrections that the reference lacks nothing is left between us;
      {"neither correction", {.firing_time_azimuth = false, .optical_centre = false}, 1e-4},
      // a laser fires up to 54.7 us before the end of its block.
      {"firing times", {.optical_centre = false}, 0.2},
  };
  for (const Case& a_case : cases) {
    const Decoded decoded = decode(capture, beams, a_case.options);
    ASSERT_EQ(decoded.points.size(), decoded.kept.size());
    const auto ours = sweep_as_the_reference(decoded, 3);
    ASSERT_EQ(ours.size(), theirs.size());
    const Differences most = test::compare(ours, theirs);
    std::cout << a_case.name << ", most: range " << most.range_m << " m, height " << most.height_m
              << " m, azimuth " << most.azimuth_deg << " deg, rms " << most.azimuth_rms_deg << " deg\n";
    EXPECT_LT(most.range_m, 1e-3) << a_case.name;
    EXPECT_LT(most.height_m, 1e-3) << a_case.name;
    EXPECT_LT(most.azimuth_deg, a_case.azimuth_deg) << a_case.name;
  }
}

/// Horizontal range over azimuth, as one channel sees the room.
using Profile = std::map<double, double>;

std::vector<Profile> profiles_of(const Decoded& decoded, int sweep) {
  std::vector<Profile> profiles(kPandar64Lasers);
  const auto returns = test::to_returns(decoded.points);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (decoded.kept[i].sweep != sweep) continue;
    const double horizontal_m =
        std::sqrt(returns[i].range_m * returns[i].range_m - returns[i].height_m * returns[i].height_m);
    profiles[decoded.kept[i].channel][returns[i].azimuth_deg] = horizontal_m;
  }
  return profiles;
}

/// Mean distance of two profiles when `b` is turned by `shift_deg`; what one sees and the other does not
/// counts little.
double mismatch_m(const Profile& a, const Profile& b, double shift_deg) {
  constexpr double kMostM = 0.2;
  double sum_m = 0.0;
  int count = 0;
  for (const auto& [azimuth_deg, range_m] : b) {
    const auto after = a.lower_bound(azimuth_deg + shift_deg);
    if (after == a.begin() || after == a.end()) continue;
    const auto before = std::prev(after);
    const double gap_deg = after->first - before->first;
    if (gap_deg > 0.5 || std::abs(after->second - before->second) > kMostM) continue;
    const double part = (azimuth_deg + shift_deg - before->first) / gap_deg;
    const double expected_m = before->second + part * (after->second - before->second);
    sum_m += std::min(std::abs(expected_m - range_m), kMostM);
    ++count;
  }
  return count == 0 ? kMostM : sum_m / count;
}

/// How far neighbouring channels that look to different sides disagree about the azimuth of the same walls.
double misalignment_rms_deg(const std::vector<Profile>& profiles, std::span<const Beam> beams) {
  double squares = 0.0;
  int pairs = 0;
  for (std::size_t a = 0; a < beams.size(); ++a) {
    for (std::size_t b = a + 1; b < beams.size(); ++b) {
      if (std::abs(beams[a].elevation_deg - beams[b].elevation_deg) > 0.2) continue;
      if (std::abs(beams[a].azimuth_offset_deg - beams[b].azimuth_offset_deg) < 1.0) continue;
      double best_deg = 0.0;
      double best_m = 1.0;
      for (double shift_deg = -0.4; shift_deg <= 0.4; shift_deg += 0.01) {
        const double distance_m = mismatch_m(profiles[a], profiles[b], shift_deg);
        if (distance_m < best_m) std::tie(best_m, best_deg) = std::pair(distance_m, shift_deg);
      }
      squares += best_deg * best_deg;
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 20);
  return std::sqrt(squares / std::max(pairs, 1));
}

TEST(Pandar64RealData, TheCorrectionsMakeNeighbouringChannelsSeeTheSameWalls) {
  LANDFIX_REAL_DATA(capture, "pandar64/capture.pcap");
  LANDFIX_REAL_DATA(calibration, "pandar64/calibration.csv");
  const auto beams = hesai::parse_calibration(platform::read_file(calibration), calibration.string(),
                                              find_sensor_model("pandar64")->beams);
  const auto misalignment_deg = [&](const DecoderOptions& options) {
    return misalignment_rms_deg(profiles_of(decode(capture, beams, options), 2), beams);
  };
  const double neither = misalignment_deg({.firing_time_azimuth = false, .optical_centre = false});
  const double firing_times = misalignment_deg({.optical_centre = false});
  const double centre = misalignment_deg({.firing_time_azimuth = false});
  const double both = misalignment_deg({});
  std::cout << "rms misalignment: neither " << neither << " deg, firing times " << firing_times
            << " deg, centre " << centre << " deg, both " << both << " deg\n";
  EXPECT_LT(centre, neither);
  EXPECT_LT(both, centre);
  EXPECT_LT(both, 0.75 * neither);
}

}  // namespace
}  // namespace landfix::drivers
