// Sweeps of recorded Velodyne sensors: whole, nothing missed, and on the right clock.
#include <string>

#include <gtest/gtest.h>

#include "real/cloud_comparison.hpp"
#include "support/test_data.hpp"

namespace landfix::drivers {
namespace {

struct Recording {
  const char* sensor;
  const char* capture;
  std::size_t packets;
  std::size_t sweeps;  ///< the first and the last are parts
  double turn_s;
  TimeSource time_source;
};

class VelodyneSweeps : public testing::TestWithParam<Recording> {};

TEST_P(VelodyneSweeps, AreWholeAndOnTheRightClock) {
  const Recording& recording = GetParam();
  LANDFIX_REAL_DATA(capture, recording.capture);
  const auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), recording.packets);
  test::DecoderBench bench = test::bench_of(recording.sensor, {});
  test::decode_all(bench, packets);
  EXPECT_EQ(bench.counters().clock_steps, 0U);
  const auto& sweeps = bench.swept();
  ASSERT_EQ(sweeps.size(), recording.sweeps);
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    EXPECT_EQ(sweeps[i].complete, i > 0 && i + 1 < recording.sweeps) << i;
    EXPECT_EQ(sweeps[i].time_source, recording.time_source) << i;
    EXPECT_EQ(sweeps[i].overflowed, 0U) << i;
    if (i < 2) continue;
    const std::int64_t since_ns = sweeps[i].start_utc_ns - sweeps[i - 1].start_utc_ns;
    EXPECT_NEAR(static_cast<double>(since_ns) * 1e-9, recording.turn_s, 2e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, VelodyneSweeps,
    testing::Values(
        // 1985 firing sequences a turn; its clock is half an hour off.
        Recording{"hdl32e", "hdl32e/capture.pcap", 603, 4, 1985 * 46.08e-6, TimeSource::receive},
        Recording{"vls128", "vls128/single-return.pcap", 2193, 5, 0.1, TimeSource::sensor}),
    [](const auto& recording) { return std::string(recording.param.sensor); });

}  // namespace
}  // namespace landfix::drivers
