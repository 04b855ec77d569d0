// An OS1-64's recorded packets: against values that the vendor's own software gives for them, against the
// vendor's formulas written out once more, and against the walls of the room.
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "drivers/calibration.hpp"
#include "drivers/ouster/metadata_file.hpp"
#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

using test::RecordedPacket;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::size_t kRows = 64;
constexpr std::size_t kColumns = 16;
constexpr std::size_t kColumnBytes = 788;

/// Of the unit that `legacy-fw20-one-frame.pcap` was recorded with: all that was kept of its metadata.
constexpr std::string_view kFirmware20Unit = R"({"lidar_mode": "1024x10",
"beam_altitude_angles": [
  16.46, 15.88, 15.32, 14.8, 14.29, 13.71, 13.17, 12.63, 12.15, 11.58, 11.05, 10.52, 10.05, 9.49,
  8.95, 8.43, 7.95, 7.41, 6.88, 6.34, 5.87, 5.33, 4.8, 4.27, 3.79, 3.26, 2.72, 2.19, 1.71, 1.18,
  0.65, 0.12, -0.36, -0.9, -1.43, -1.96, -2.44, -2.97, -3.51, -4.04, -4.52, -5.05, -5.58, -6.12,
  -6.61, -7.13, -7.67, -8.22, -8.7, -9.22, -9.76, -10.3, -10.8, -11.33, -11.86, -12.43, -12.91,
  -13.45, -14, -14.57, -15.07, -15.6, -16.17, -16.75],
"beam_azimuth_angles": [
  3.12, 0.97, -1.18, -3.3, 3.09, 0.97, -1.15, -3.25, 3.09, 0.98, -1.12, -3.21, 3.08, 0.99, -1.09,
  -3.17, 3.08, 1, -1.06, -3.15, 3.08, 1.02, -1.05, -3.12, 3.1, 1.03, -1.04, -3.1, 3.11, 1.04,
  -1.03, -3.09, 3.12, 1.04, -1.01, -3.09, 3.14, 1.07, -1, -3.08, 3.15, 1.07, -1, -3.08, 3.17, 1.08,
  -0.99, -3.1, 3.19, 1.1, -0.98, -3.09, 3.23, 1.12, -0.99, -3.11, 3.24, 1.12, -1, -3.13, 3.29,
  1.14, -1.01, -3.17]})";

ouster::Metadata parse(std::string_view text) {
  return ouster::parse_metadata(*find_sensor_model("os1-64"), std::as_bytes(std::span(text)), "unit.json");
}

std::vector<test::SweepCopy> decode(std::span<const RecordedPacket> packets,
                                    const ouster::Metadata& metadata) {
  return test::decode_sweeps("os1-64", packets, {}, metadata);
}

template <class T>
T field(const RecordedPacket& packet, std::size_t at) {
  T value;
  std::memcpy(&value, packet.payload.data() + at, sizeof(value));
  return value;
}

/// A return as the vendor's formulas place it, in doubles.
struct Expected {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double time_s = 0.0;  ///< since the packet's first column
  unsigned intensity = 0;
  unsigned ring = 0;
};

std::vector<Expected> by_the_formulas(const RecordedPacket& packet, const ouster::Metadata& metadata) {
  constexpr double kOriginMm = 12.163;
  constexpr double kLiftMm = 36.18;
  std::vector<Expected> all;
  const auto first_ns = field<std::uint64_t>(packet, 0);
  for (std::size_t c = 0; c < kColumns; ++c) {
    const std::size_t column = c * kColumnBytes;
    const double encoder_rad =
        2.0 * std::numbers::pi * (1.0 - field<std::uint16_t>(packet, column + 8) / 1024.0);
    for (std::size_t row = 0; row < kRows; ++row) {
      const std::size_t pixel = column + 16 + 12 * row;
      const double range_mm = field<std::uint32_t>(packet, pixel) & 0xFFFFFU;
      if (range_mm == 0.0) continue;
      const double azimuth_rad = -metadata.rows[row].azimuth_deg * kRadPerDeg;
      const double altitude_rad = metadata.rows[row].altitude_deg * kRadPerDeg;
      const double along_mm = range_mm - kOriginMm;
      const double x = along_mm * std::cos(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
                       kOriginMm * std::cos(encoder_rad);
      const double y = along_mm * std::sin(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
                       kOriginMm * std::sin(encoder_rad);
      all.push_back({.x = -1e-3 * x,
                     .y = -1e-3 * y,
                     .z = 1e-3 * (along_mm * std::sin(altitude_rad) + kLiftMm),
                     .time_s = 1e-9 * static_cast<double>(field<std::uint64_t>(packet, column) - first_ns),
                     .intensity = field<std::uint8_t>(packet, pixel + 4),
                     .ring = static_cast<unsigned>(kRows - 1 - row)});
    }
  }
  return all;
}

TEST(Os1RealData, GivesWhatTheVendorsSoftwareGives) {
  LANDFIX_REAL_DATA(capture, "os1-64/legacy-fw20-one-frame.pcap");
  struct Golden {
    std::size_t column, row;
    unsigned range_mm, reflectivity, signal, near_infrared;
    double x, y, z;
  };
  constexpr Golden kGoldens[] = {{0, 20, 1537, 106, 44, 14, -1.5268, 0.0815, 0.1921},
                                 {15, 40, 860, 52, 70, 17, -0.8482, 0.1249, -0.0306}};
  const auto packets = test::read_packets(capture, 7502);
  ASSERT_EQ(packets.size(), 64U);
  EXPECT_EQ(field<std::uint64_t>(packets[0], 0), 278'211'490'950U);
  EXPECT_EQ(field<std::uint16_t>(packets[0], 10), 189U);
  const auto sweeps = decode(std::span(packets).first(1), parse(kFirmware20Unit));
  ASSERT_EQ(sweeps.size(), 1U);
  for (const Golden& golden : kGoldens) {
    const std::size_t column = golden.column * kColumnBytes;
    const std::size_t pixel = column + 16 + 12 * golden.row;
    EXPECT_EQ(field<std::uint32_t>(packets[0], pixel) & 0xFFFFFU, golden.range_mm);
    EXPECT_EQ(field<std::uint16_t>(packets[0], pixel + 6), golden.signal);
    EXPECT_EQ(field<std::uint16_t>(packets[0], pixel + 8), golden.near_infrared);
    const double time_s = 1e-9 * static_cast<double>(field<std::uint64_t>(packets[0], column) -
                                                     field<std::uint64_t>(packets[0], 0));
    const auto found = std::ranges::find_if(sweeps[0].points, [&](const Point& point) {
      return point.ring == kRows - 1 - golden.row &&
             std::abs(static_cast<double>(point.time_s) - time_s) < 1e-8;
    });
    ASSERT_NE(found, sweeps[0].points.end());
    EXPECT_NEAR(found->x, golden.x, 6e-5);
    EXPECT_NEAR(found->y, golden.y, 6e-5);
    EXPECT_NEAR(found->z, golden.z, 6e-5);
    EXPECT_EQ(found->intensity, static_cast<float>(golden.reflectivity));
  }
}

TEST(Os1RealData, AgreesWithTheFormulasInEveryReturn) {
  LANDFIX_REAL_DATA(one_frame, "os1-64/legacy-fw20-one-frame.pcap");
  LANDFIX_REAL_DATA(three_frames, "os1-64/legacy-100-packets.pcap");
  LANDFIX_REAL_DATA(unit, "os1-64/legacy-100-packets.json");
  const auto file = platform::read_file(unit);
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  for (const auto& [capture, metadata] :
       {std::pair{one_frame, parse(kFirmware20Unit)}, std::pair{three_frames, parse(text)}}) {
    const auto packets = test::read_packets(capture, 7502);
    test::DecoderBench bench = test::bench_of("os1-64", {}, metadata);
    test::decode_all(bench, packets);
    const std::vector<Point> ours = bench.all_points();
    std::size_t at = 0;
    double most_m = 0.0;
    for (const RecordedPacket& packet : packets) {
      const double packet_time_s = at < ours.size() ? static_cast<double>(ours[at].time_s) : 0.0;
      double first_time_s = -1.0;
      for (const Expected& theirs : by_the_formulas(packet, metadata)) {
        ASSERT_LT(at, ours.size());
        const Point& point = ours[at++];
        const double x = static_cast<double>(point.x) - theirs.x;
        const double y = static_cast<double>(point.y) - theirs.y;
        const double z = static_cast<double>(point.z) - theirs.z;
        most_m = std::max(most_m, std::sqrt(x * x + y * y + z * z));
        if (first_time_s < 0.0) first_time_s = theirs.time_s;
        ASSERT_NEAR(static_cast<double>(point.time_s) - packet_time_s, theirs.time_s - first_time_s, 2e-8);
        ASSERT_EQ(point.intensity, static_cast<float>(theirs.intensity));
        ASSERT_EQ(point.ring, theirs.ring);
      }
    }
    EXPECT_EQ(at, ours.size());
    EXPECT_GT(at, 10'000U);
    EXPECT_LT(most_m, 2e-5);
    std::cout << capture.filename() << ": " << at << " returns, at most " << 1e6 * most_m << " um apart\n";
  }
}

TEST(Os1RealData, CutsAtTheSensorsFrames) {
  LANDFIX_REAL_DATA(capture, "os1-64/legacy-100-packets.pcap");
  LANDFIX_REAL_DATA(unit, "os1-64/legacy-100-packets.json");
  const SensorModel& model = *find_sensor_model("os1-64");
  const auto calibration = parse_calibration(model, platform::read_file(unit), unit.string());
  const auto packets = test::read_packets(capture, model.data_port);
  ASSERT_EQ(packets.size(), 100U);
  for (const RecordedPacket& packet : packets) EXPECT_TRUE(looks_like(model, packet.payload));
  test::DecoderBench bench = test::bench_of("os1-64", {}, calibration);
  test::decode_all(bench, packets);
  EXPECT_EQ(bench.counters().restarts, 0U);
  EXPECT_EQ(bench.counters().clock_steps, 0U);
  const auto& sweeps = bench.swept();
  ASSERT_EQ(sweeps.size(), 3U);
  // 14 packets of a frame that began before the recording, a whole one, 22 of one that goes on after it.
  const std::size_t first_packets[] = {0, 14, 78};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sweeps[i].complete, i == 1) << i;
    EXPECT_EQ(sweeps[i].time_source, TimeSource::sensor);
    EXPECT_EQ(static_cast<std::uint64_t>(sweeps[i].start_utc_ns),
              field<std::uint64_t>(packets[first_packets[i]], 0));
  }
  EXPECT_NEAR(static_cast<double>(sweeps[1].points.back().time_s), 0.1, 1e-3);
}

TEST(Os1RealData, CountsFromPowerUpAreAnchoredToTheReceiver) {
  LANDFIX_REAL_DATA(capture, "os1-64/legacy-fw20-one-frame.pcap");
  const auto packets = test::read_packets(capture, 7502);
  const auto sweeps = decode(packets, parse(kFirmware20Unit));
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_TRUE(sweeps[0].complete);
  EXPECT_EQ(sweeps[0].time_source, TimeSource::receive);
  EXPECT_NEAR(1e-9 * static_cast<double>(sweeps[0].start_utc_ns - packets[0].receive_utc_ns), 0.0, 2e-3);
}

/// Horizontal range over azimuth, as one row sees the room.
using Profile = std::map<double, double>;

/// How many of `a`'s returns `b` places elsewhere at the same azimuth, by more than 5 % of the range.
struct Votes {
  std::size_t against = 0;
  std::size_t all = 0;
};

void compare(const Profile& a, const Profile& b, Votes& votes) {
  constexpr double kGapDeg = 1.0;
  for (const auto& [azimuth_deg, range_m] : a) {
    const auto after = b.lower_bound(azimuth_deg);
    if (after == b.begin() || after == b.end()) continue;
    const auto before = std::prev(after);
    if (after->first - before->first > kGapDeg) continue;
    const double share = (azimuth_deg - before->first) / (after->first - before->first);
    const double other_m = before->second + share * (after->second - before->second);
    if (std::abs(range_m - other_m) > 0.05 * range_m) ++votes.against;
    ++votes.all;
  }
}

/// Share of the returns on which neighbouring rows, whose azimuths differ by 2 to 6 deg, disagree [%].
double disagreement_percent(std::span<const Point> points) {
  std::vector<Profile> profiles(kRows);
  for (const Point& point : points) {
    const auto x = static_cast<double>(point.x);
    const auto y = static_cast<double>(point.y);
    profiles[point.ring][std::atan2(y, x) / kRadPerDeg] = std::hypot(x, y);
  }
  Votes votes;
  for (std::size_t ring = 0; ring + 1 < kRows; ++ring) compare(profiles[ring], profiles[ring + 1], votes);
  return 100.0 * static_cast<double>(votes.against) / static_cast<double>(votes.all);
}

TEST(Os1RealData, NeighbouringRowsAgreeOnTheWallsByTheirAzimuths) {
  LANDFIX_REAL_DATA(one_frame, "os1-64/legacy-fw20-one-frame.pcap");
  LANDFIX_REAL_DATA(three_frames, "os1-64/legacy-100-packets.pcap");
  LANDFIX_REAL_DATA(unit, "os1-64/legacy-100-packets.json");
  const auto file = platform::read_file(unit);
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  struct Recording {
    std::filesystem::path capture;
    ouster::Metadata metadata;
    std::size_t sweep;  ///< the whole one
  };
  for (const Recording& recording :
       {Recording{one_frame, parse(kFirmware20Unit), 0}, Recording{three_frames, parse(text), 1}}) {
    const auto packets = test::read_packets(recording.capture, 7502);
    const auto with = [&](double factor) {
      ouster::Metadata metadata = recording.metadata;
      for (ouster::Row& row : metadata.rows) row.azimuth_deg *= factor;
      return disagreement_percent(decode(packets, metadata).at(recording.sweep).points);
    };
    const double right_percent = with(1.0);
    const double without_percent = with(0.0);
    // The same as an encoder that counts the other way, but for a mirror: azimuths against the encoder.
    const double flipped_percent = with(-1.0);
    std::cout << recording.capture.filename() << ": neighbouring rows disagree on " << right_percent
              << " %, without azimuths on " << without_percent << " %, with their sign flipped on "
              << flipped_percent << " %\n";
    EXPECT_LT(right_percent, 0.8 * without_percent);
    EXPECT_LT(without_percent, 0.8 * flipped_percent);
  }
}

}  // namespace
}  // namespace landfix::drivers
