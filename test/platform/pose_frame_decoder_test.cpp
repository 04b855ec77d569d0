#include "platform/pose_frame_decoder.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "platform/pose_frames.hpp"
#include "support/random_pose_report.hpp"

namespace landfix::platform {
namespace {

constexpr std::uint32_t kBaseId = 0x3A0;
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kSweep_ns = 100'000'000;

/// The frames of so many poses, as they follow each other on the bus.
std::vector<CanFrame> drive(std::size_t poses, bool fd, bool is_geodetic = false) {
  PoseFrameEncoder encoder(kBaseId, fd, is_geodetic);
  std::mt19937_64 random(3);
  std::vector<CanFrame> frames;
  for (std::size_t i = 0; i < poses; ++i) {
    PoseReport report = test::random_report(random, pose_layouts(fd));
    report.stamp_utc_ns = kStart_ns + static_cast<std::int64_t>(i) * kSweep_ns;
    const PoseFrames sent = encoder.encode(report);
    frames.insert(frames.end(), sent.all().begin(), sent.all().end());
  }
  return frames;
}

struct Reception {
  std::size_t poses = 0;
  std::size_t faults = 0;
};

Reception receive(const std::vector<CanFrame>& frames) {
  PoseFrameDecoder decoder(kBaseId);
  Reception reception;
  for (const CanFrame& frame : frames) {
    const DecodedFrame decoded = decoder.decode(frame, kStart_ns);
    if (decoded.pose) ++reception.poses;
    if (decoded.has_fault()) ++reception.faults;
  }
  if (decoder.frames_missing() != 0) ++reception.faults;
  return reception;
}

bool is_map(const CanFrame& frame) { return frame.id == kBaseId + kFrameLayouts[kMapFrameIndex].id_offset; }

TEST(PoseFrameDecoder, GivesBackEveryPose) {
  std::mt19937_64 random(1);
  for (const bool fd : {false, true}) {
    PoseFrameEncoder encoder(kBaseId, fd);
    PoseFrameDecoder decoder(kBaseId);
    for (int i = 0; i < 1000; ++i) {
      const PoseReport report = test::random_report(random, pose_layouts(fd));
      std::optional<PoseReport> received;
      for (const PoseFrames frames = encoder.encode(report); const CanFrame& frame : frames.all()) {
        const DecodedFrame decoded = decoder.decode(frame, kStart_ns);
        EXPECT_FALSE(decoded.has_fault());
        if (decoded.pose) received = decoded.pose;
      }
      ASSERT_TRUE(received);
      EXPECT_NEAR(received->x_m, report.x_m, 0.00051);
      EXPECT_NEAR(received->yaw_rad, report.yaw_rad, 0.000051);
      EXPECT_NEAR(received->speed_x_mps, report.speed_x_mps, 0.00251);
      EXPECT_NEAR(static_cast<double>(received->stamp_utc_ns - report.stamp_utc_ns), 0.0, 5000.0);
      EXPECT_EQ(received->state, report.state);
      EXPECT_EQ(received->weak, report.weak);
    }
  }
}

TEST(PoseFrameDecoder, KnowsTheMapOfEachPose) {
  PoseFrameEncoder encoder(kBaseId, false);
  PoseFrameDecoder decoder(kBaseId);
  PoseReport report;
  report.map_hash = 0xBEEF;
  std::optional<PoseReport> last;
  for (int i = 0; i < 2; ++i) {
    for (const PoseFrames frames = encoder.encode(report); const CanFrame& frame : frames.all()) {
      const DecodedFrame decoded = decoder.decode(frame, kStart_ns);
      if (decoded.pose) last = decoded.pose;
    }
  }
  ASSERT_TRUE(last);
  EXPECT_EQ(last->map_hash, 0xBEEF);
}

TEST(PoseFrameDecoder, GivesLatitudeAndLongitudeTogether) {
  PoseFrameEncoder encoder(kBaseId, false, true);
  PoseFrameDecoder decoder(kBaseId);
  PoseReport report;
  report.latitude_deg = 35.6866094838;
  report.longitude_deg = 139.6738201417;
  report.utm_zone = 54;
  report.state = 5;
  int received = 0;
  for (int i = 0; i < 3; ++i) {
    report.stamp_utc_ns = kStart_ns + i * kSweep_ns;
    for (const PoseFrames frames = encoder.encode(report); const CanFrame& frame : frames.all()) {
      // The second latitude is lost: its longitude is of no use.
      if (i == 1 && frame.id == kBaseId + kLatitudeFrameIndex) continue;
      const DecodedFrame decoded = decoder.decode(frame, report.stamp_utc_ns);
      if (!decoded.geodetic) continue;
      ++received;
      EXPECT_NE(i, 1);
      EXPECT_NEAR(decoded.geodetic->latitude_deg, report.latitude_deg, 2e-10);
      EXPECT_NEAR(decoded.geodetic->longitude_deg, report.longitude_deg, 2e-10);
      EXPECT_EQ(decoded.geodetic->utm_zone, 54);
      EXPECT_EQ(decoded.geodetic->state, 5);
    }
  }
  EXPECT_EQ(received, 2);
}

TEST(PoseFrameDecoder, SeesEverySingleBitError) {
  for (const bool fd : {false, true}) {
    for (const CanFrame& frame : drive(3, fd)) {
      for (std::size_t bit = 0; bit < 8 * frame.payload().size(); ++bit) {
        CanFrame damaged = frame;
        damaged.data[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
        const DecodedFrame decoded = PoseFrameDecoder(kBaseId).decode(damaged, kStart_ns);
        EXPECT_EQ(decoded.check.status, E2eStatus::wrong_crc) << frame.id << ' ' << bit;
        EXPECT_FALSE(decoded.pose);
      }
    }
  }
}

TEST(PoseFrameDecoder, SeesAFrameInThePlaceOfAnother) {
  const std::vector<CanFrame> frames = drive(1, false);
  for (const CanFrame& frame : frames) {
    for (const CanFrame& other : frames) {
      if (frame.id == other.id) continue;
      CanFrame masked = frame;
      masked.id = other.id;
      EXPECT_EQ(PoseFrameDecoder(kBaseId).decode(masked, kStart_ns).check.status, E2eStatus::wrong_crc);
    }
  }
}

TEST(PoseFrameDecoder, SeesEverySwapOfTwoFrames) {
  for (const bool fd : {false, true}) {
    const std::vector<CanFrame> frames = drive(fd ? 40 : 5, fd);
    ASSERT_EQ(receive(frames).faults, 0U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (std::size_t j = i + 1; j < frames.size(); ++j) {
        // LOC_MAP goes with no pose, so that there is no order to it.
        if (is_map(frames[i]) || is_map(frames[j])) continue;
        std::vector<CanFrame> swapped = frames;
        std::swap(swapped[i], swapped[j]);
        EXPECT_GE(receive(swapped).faults, 1U) << i << ' ' << j;
      }
    }
  }
}

TEST(PoseFrameDecoder, SeesEverySwapOfLatitudeLongitudeAndMapToo) {
  for (const bool fd : {false, true}) {
    const std::vector<CanFrame> frames = drive(14, fd, true);  // as many as a counter tells apart
    ASSERT_EQ(receive(frames).faults, 0U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (std::size_t j = i + 1; j < frames.size(); ++j) {
        // A pose that is one frame, and LOC_MAP, which belongs to none, have no order.
        if (fd && (is_map(frames[i]) || is_map(frames[j]))) continue;
        std::vector<CanFrame> swapped = frames;
        std::swap(swapped[i], swapped[j]);
        EXPECT_GE(receive(swapped).faults, 1U) << i << ' ' << j;
      }
    }
  }
}

TEST(PoseFrameDecoder, SeesEveryRepeatedFrame) {
  for (const bool fd : {false, true}) {
    const std::vector<CanFrame> frames = drive(fd ? 40 : 12, fd);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (std::size_t j = i + 1; j <= frames.size(); ++j) {
        std::vector<CanFrame> repeated = frames;
        repeated.insert(repeated.begin() + static_cast<std::ptrdiff_t>(j), frames[i]);
        EXPECT_GE(receive(repeated).faults, 1U) << i << ' ' << j;
      }
    }
  }
}

/// Without so many of them from the index on.
std::vector<CanFrame> without(const std::vector<CanFrame>& frames, std::size_t first, std::size_t count) {
  std::vector<CanFrame> rest = frames;
  const auto begin = rest.begin() + static_cast<std::ptrdiff_t>(first);
  rest.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return rest;
}

TEST(PoseFrameDecoder, SeesUpToFourteenFramesMissingFromTheBus) {
  for (const bool fd : {false, true}) {
    std::vector<CanFrame> frames = drive(30, fd);
    std::erase_if(frames, is_map);
    for (std::size_t first = 1; first < frames.size(); ++first) {
      for (std::size_t count = 1; count <= 14 && first + count < frames.size(); ++count) {
        EXPECT_GE(receive(without(frames, first, count)).faults, 1U) << first << ' ' << count;
      }
    }
  }
}

// Every kind of frame, LOC_MAP too; what comes after the gap shows it.
TEST(PoseFrameDecoder, SeesUpToFourteenFramesMissingFromAStream) {
  for (const FrameLayout& layout : kFrameLayouts) {
    std::vector<CanFrame> stream;
    std::uint8_t counter = 0;
    for (int i = 0; i < 40; ++i) {
      stream.push_back(encode_frame(layout, kBaseId, counter, {}));
      counter = next_e2e_counter(layout.profile(), counter);
    }
    for (std::size_t first = 1; first < stream.size(); ++first) {
      for (std::size_t count = 1; count <= 14 && first + count < stream.size(); ++count) {
        PoseFrameDecoder decoder(kBaseId);
        std::size_t violations = 0;
        for (const CanFrame& frame : without(stream, first, count)) {
          if (decoder.decode(frame, kStart_ns).check.status != E2eStatus::ok) ++violations;
        }
        EXPECT_EQ(violations, 1U) << layout.name << ' ' << first << ' ' << count;
      }
    }
  }
}

TEST(PoseFrameDecoder, SeesFourteenPosesMissingAtOnce) {
  for (const bool fd : {false, true}) {
    PoseFrameEncoder encoder(kBaseId, fd);
    PoseFrameDecoder decoder(kBaseId);
    for (int skipped = 1; skipped <= 14; ++skipped) {
      for (const PoseFrames frames = encoder.encode({}); const CanFrame& frame : frames.all())
        (void)decoder.decode(frame, kStart_ns);
      for (int i = 0; i < skipped; ++i) (void)encoder.encode({});
      for (const PoseFrames frames = encoder.encode({}); const CanFrame& frame : frames.all()) {
        EXPECT_TRUE(decoder.decode(frame, kStart_ns).has_fault() || is_map(frame)) << skipped;
      }
    }
  }
}

TEST(PoseFrameDecoder, GivesNoPoseOfFramesThatDoNotBelongTogether) {
  std::vector<CanFrame> frames = drive(3, false);
  frames.erase(frames.begin() + 8);  // the second pose's attitude; before it are 6 frames and the map's
  const Reception reception = receive(frames);
  EXPECT_EQ(reception.poses, 2U);
  EXPECT_EQ(reception.faults,
            2U);  // the next position ends an incomplete pose, the next attitude counts one lost
}

// The counter alone would not tell: of each kind of frame none, or a full turn of the counter, is missing.
TEST(PoseFrameDecoder, FramesATurnOfTheCounterApartMakeNoPose) {
  const PoseReport report;
  PoseFrameDecoder decoder(kBaseId);
  const auto receive_one = [&](std::size_t index, std::uint8_t counter, std::int64_t after_ns) {
    return decoder.decode(encode_frame(kFrameLayouts[index], kBaseId, counter, report), kStart_ns + after_ns);
  };
  for (std::size_t i = 0; i < kClassicPoseFrames; ++i) (void)receive_one(i, 2, 0);
  EXPECT_FALSE(receive_one(0, 3, 10'000'000).has_fault());
  EXPECT_EQ(receive_one(1, 3, 160'000'000).frames_missing, 5U);
  for (std::size_t i = 2; i < kClassicPoseFrames; ++i) EXPECT_FALSE(receive_one(i, 3, 160'000'000).pose);
}

TEST(PoseFrameDecoder, GoesOnAfterALoss) {
  std::vector<CanFrame> frames = drive(40, true);
  std::erase_if(frames, is_map);
  frames.erase(frames.begin() + 10, frames.begin() + 20);
  const Reception reception = receive(frames);
  EXPECT_EQ(reception.faults, 1U);
  EXPECT_EQ(reception.poses, 29U);  // the first after the loss is not accepted
}

TEST(PoseFrameDecoder, SeesSilence) {
  const std::vector<CanFrame> frames = drive(2, true);
  PoseFrameDecoder decoder(kBaseId);
  EXPECT_EQ(decoder.decode(frames[0], kStart_ns).silence_ns, 0);
  EXPECT_EQ(decoder.decode(frames[2], kStart_ns + 600'000'000).silence_ns, 600'000'000);
}

TEST(PoseFrameDecoder, LeavesFramesOfOthersAlone) {
  const CanFrame ours = drive(1, false).front();
  CanFrame extended = ours;
  extended.extended = true;
  CanFrame elsewhere = ours;
  elsewhere.id = kBaseId + 10;
  for (const CanFrame& frame : {extended, elsewhere}) {
    const DecodedFrame decoded = PoseFrameDecoder(kBaseId).decode(frame, kStart_ns);
    EXPECT_EQ(decoded.layout, nullptr);
    EXPECT_FALSE(decoded.has_fault());
  }
}

TEST(PoseFrameDecoder, AFrameOfAnotherFormatIsNotTheFrame) {
  const CanFrame ours = drive(1, false).front();
  CanFrame shorter = ours;
  shorter.length = 7;
  CanFrame fd = ours;
  fd.fd = true;
  CanFrame longer = ours;
  longer.length = 255;
  for (const CanFrame& frame : {shorter, fd, longer}) {
    EXPECT_EQ(PoseFrameDecoder(kBaseId).decode(frame, kStart_ns).check.status, E2eStatus::wrong_crc);
  }
}

}  // namespace
}  // namespace landfix::platform
