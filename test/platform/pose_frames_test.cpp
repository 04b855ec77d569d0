#include "platform/pose_frames.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "platform/e2e.hpp"
#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double sent(const Signal& signal, double value) {
  std::array<std::byte, 8> data{};
  (void)encode_signal(signal, value, data);
  return decode_signal(signal, data);
}

bool saturates(const Signal& signal, double value) {
  std::array<std::byte, 8> data{};
  return encode_signal(signal, value, data);
}

TEST(PoseFrames, AreTheGoldenFrames) {
  const EncodedFrame position = encode_frame(kPositionFrame, 0x3A0, 3, std::array{1234.567, -89.012});
  EXPECT_EQ(position.frame.id, 0x3A0U);
  EXPECT_TRUE(same(position.frame.data, bytes({0x47, 0x13, 0x87, 0xD6, 0x12, 0x4C, 0xA4, 0xFE})));
  EXPECT_FALSE(position.saturated);
  const EncodedFrame attitude = encode_frame(kAttitudeFrame, 0x3A0, 3, std::array{1.5708, -0.0123, 0.0045});
  EXPECT_EQ(attitude.frame.id, 0x3A1U);
  EXPECT_TRUE(same(attitude.frame.data, bytes({0xFE, 0x13, 0x5C, 0x3D, 0x85, 0xFF, 0x2D, 0x00})));
}

TEST(PoseFrames, DecodeToWithinHalfAStep) {
  std::mt19937_64 random(1);
  for (const FrameLayout& layout : kFrameLayouts) {
    for (const Signal& signal : layout.signals) {
      const double limit = signal.scale * (std::ldexp(1.0, signal.length_bits - 1) - 1.0);
      std::uniform_real_distribution<double> uniform(-limit, limit);
      for (int i = 0; i < 10000; ++i) {
        const double value = uniform(random);
        EXPECT_NEAR(sent(signal, value), value, 0.5 * signal.scale * (1 + 1e-9)) << signal.name;
      }
    }
  }
}

TEST(PoseFrames, SignalsDoNotDisturbEachOther) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (const FrameLayout& layout : kFrameLayouts) {
    for (int i = 0; i < 1000; ++i) {
      std::array<double, 8> values{};
      for (double& value : values) value = uniform(random);
      const auto used = std::span(values).first(layout.signals.size());
      const EncodedFrame encoded = encode_frame(layout, 0x100, 0, used);
      for (std::size_t s = 0; s < used.size(); ++s) {
        EXPECT_NEAR(decode_signal(layout.signals[s], encoded.frame.data), used[s],
                    0.51 * layout.signals[s].scale);
      }
    }
  }
}

TEST(PoseFrames, RoundHalfToEven) {
  const Signal half{.name = "HALF", .start_bit = 16, .length_bits = 16, .is_signed = true, .scale = 2.0};
  EXPECT_EQ(sent(half, 1.0), 0.0);
  EXPECT_EQ(sent(half, 3.0), 4.0);
  EXPECT_EQ(sent(half, 5.0), 4.0);
  EXPECT_EQ(sent(half, -1.0), 0.0);
  EXPECT_EQ(sent(half, -3.0), -4.0);
}

TEST(PoseFrames, ClampAndNeverWrap) {
  const Signal& x = kPositionSignals[0];
  EXPECT_NEAR(sent(x, 9000.0), 8388.607, 1e-9);
  EXPECT_NEAR(sent(x, -9000.0), -8388.607, 1e-9);
  EXPECT_NEAR(sent(x, kInfinity), 8388.607, 1e-9);
  EXPECT_NEAR(sent(x, -1e300), -8388.607, 1e-9);
  for (const double value : {9000.0, -9000.0, kInfinity, -kInfinity, 8388.608, -8388.608}) {
    EXPECT_TRUE(saturates(x, value)) << value;
  }
  EXPECT_FALSE(saturates(x, 8388.607));
  EXPECT_FALSE(saturates(x, -8388.607));
}

TEST(PoseFrames, NotAvailableIsAValueOfItsOwn) {
  EXPECT_TRUE(std::isnan(sent(kPositionSignals[0], kNan)));
  EXPECT_FALSE(saturates(kPositionSignals[0], kNan));
  const Signal sigma{.name = "SIGMA", .start_bit = 20, .length_bits = 12, .scale = 0.001};
  EXPECT_TRUE(std::isnan(sent(sigma, kNan)));
  EXPECT_NEAR(sent(sigma, 100.0), 4.094, 1e-12);
  EXPECT_EQ(sent(sigma, -1.0), 0.0);
  EXPECT_TRUE(saturates(sigma, -1.0));
  std::array<std::byte, 8> data{};
  (void)encode_signal(kPositionSignals[0], kNan, data);
  EXPECT_TRUE(same(std::span(data).subspan(2, 3), bytes({0x00, 0x00, 0x80})));
}

TEST(PoseFrames, OfOnePoseShareACounterThatCountsPoses) {
  PoseFrameEncoder encoder(0x200);
  E2eChecker position(kPositionFrame.data_id());
  E2eChecker attitude(kAttitudeFrame.data_id());
  for (int i = 0; i < 40; ++i) {
    const PoseFrames frames = encoder.encode(ndt::make_pose({i * 1.0, -2.0, 3.0}, {0.01, -0.02, 0.3}));
    EXPECT_EQ(frames.frames[0].id, 0x200U);
    EXPECT_EQ(frames.frames[1].id, 0x201U);
    EXPECT_EQ(frames.frames[0].data[1] & std::byte{0x0F}, std::byte{static_cast<unsigned char>(i % 15)});
    EXPECT_EQ(position.check(frames.frames[0].data), E2eStatus::ok);
    EXPECT_EQ(attitude.check(frames.frames[1].data), E2eStatus::ok);
    EXPECT_NEAR(decode_signal(kPositionSignals[0], frames.frames[0].data), i, 1e-9);
    EXPECT_NEAR(decode_signal(kAttitudeSignals[0], frames.frames[1].data), 0.3, 1e-9);
    EXPECT_NEAR(decode_signal(kAttitudeSignals[1], frames.frames[1].data), -0.02, 1e-9);
    EXPECT_NEAR(decode_signal(kAttitudeSignals[2], frames.frames[1].data), 0.01, 1e-9);
    EXPECT_FALSE(frames.saturated);
  }
  EXPECT_TRUE(encoder.encode(ndt::make_pose({1e5, 0, 0}, {})).saturated);
}

TEST(PoseFrames, YawOfHalfATurnIsPositive) {
  ndt::Pose backwards = ndt::Pose::Identity();
  backwards.linear() << -1, 0.0, 0, -0.0, -1, 0, 0, 0, 1;  // atan2(-0, -1) is -pi
  const PoseFrames frames = PoseFrameEncoder(0x200).encode(backwards);
  EXPECT_NEAR(decode_signal(kAttitudeSignals[0], frames.frames[1].data), 3.1416, 1e-9);
}

}  // namespace
}  // namespace landfix::platform
