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
  const SensorModel& model = *find_sensor_model(recording.sensor);
  AnyDecoder decoder = make_decoder(model, {});
  std::vector<Point> storage(2 * model.max_points_per_sweep());
  SweepPair sweeps(storage);
  std::size_t count = 0;
  std::int64_t last_start_ns = 0;
  const auto check = [&] {
    const Sweep& sweep = sweeps.completed();
    EXPECT_EQ(sweep.complete(), count > 0 && count + 1 < recording.sweeps) << count;
    EXPECT_EQ(sweep.time_source(), recording.time_source) << count;
    EXPECT_EQ(sweep.overflowed(), 0U) << count;
    if (count > 1) {
      EXPECT_NEAR(static_cast<double>(sweep.start_utc_ns() - last_start_ns) * 1e-9, recording.turn_s, 2e-4);
    }
    last_start_ns = sweep.start_utc_ns();
    ++count;
  };
  const auto packets = test::read_packets(capture, 2368);
  EXPECT_EQ(packets.size(), recording.packets);
  for (const auto& packet : packets) {
    const DecodeResult result = decoder.decode(packet.view(), sweeps);
    EXPECT_EQ(result.status, DecodeStatus::decoded);
    if (result.sweep_completed) check();
  }
  if (decoder.flush(sweeps)) check();
  EXPECT_EQ(count, recording.sweeps);
  EXPECT_EQ(decoder.counters().lost_packets, 0U);
  EXPECT_EQ(decoder.counters().clock_steps, 0U);
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
