#include "platform/ip_reassembly.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

constexpr std::int64_t kNow_utc_ns = 1'700'000'000'000'000'000;

/// Slices of a datagram of `data`, of `step` bytes each but for the last.
std::vector<IpFragment> split(const Bytes& datagram, std::uint16_t identification, std::size_t step = 1480) {
  std::vector<IpFragment> fragments;
  for (std::size_t offset = 0; offset < datagram.size(); offset += step) {
    const std::size_t size = std::min(step, datagram.size() - offset);
    fragments.push_back({.bytes = std::span(datagram).subspan(offset, size),
                         .source_address = 0xC0A801C9,
                         .destination_address = 0xC0A80101,
                         .identification = identification,
                         .offset = offset,
                         .more = offset + size < datagram.size()});
  }
  return fragments;
}

class IpReassemblyTest : public testing::Test {
 protected:
  std::optional<UdpDatagram> add(const IpFragment& fragment, std::int64_t after_ns = 0) {
    return reassembly_->add(fragment, kNow_utc_ns + after_ns);
  }
  std::optional<UdpDatagram> add_all(const std::vector<IpFragment>& fragments) {
    std::optional<UdpDatagram> last;
    for (const IpFragment& fragment : fragments) {
      EXPECT_FALSE(last) << "a datagram was complete before its last fragment";
      last = add(fragment);
    }
    return last;
  }
  const ReassemblyCounters& counters() const { return reassembly_->counters(); }

  std::unique_ptr<IpReassembly> reassembly_ = std::make_unique<IpReassembly>();
};

TEST_F(IpReassemblyTest, OusterPacketsComeOutWhole) {
  for (const std::size_t size : {12608U, 33024U, 65507U}) {
    const Bytes data = payload(size);
    const Bytes datagram = udp(data);
    const auto whole = add_all(split(datagram, static_cast<std::uint16_t>(size)));
    ASSERT_TRUE(whole) << size;
    EXPECT_TRUE(same(whole->payload, data));
    EXPECT_EQ(whole->source_address, 0xC0A801C9U);
    EXPECT_EQ(whole->destination_port, 2369);
  }
  EXPECT_EQ(counters().reassembled, 3U);
  EXPECT_EQ(counters().dropped, 0U);
}

TEST_F(IpReassemblyTest, AnyOrderWillDo) {
  std::mt19937_64 random(1);
  for (std::uint16_t round = 0; round < 100; ++round) {
    const Bytes data = payload(5000 + round, round);
    const Bytes datagram = udp(data);
    auto fragments = split(datagram, round, 8 * (1 + random() % 100));
    std::shuffle(fragments.begin(), fragments.end(), random);
    const auto whole = add_all(fragments);
    ASSERT_TRUE(whole);
    EXPECT_TRUE(same(whole->payload, data));
  }
}

TEST_F(IpReassemblyTest, DatagramsMayInterleave) {
  const Bytes a = udp(payload(4000, 1));
  const Bytes b = udp(payload(4000, 2));
  const auto of_a = split(a, 1);
  const auto of_b = split(b, 2);
  for (std::size_t i = 0; i + 1 < of_a.size(); ++i) {
    EXPECT_FALSE(add(of_a[i]));
    EXPECT_FALSE(add(of_b[i]));
  }
  EXPECT_TRUE(same(add(of_a.back())->payload, payload(4000, 1)));
  EXPECT_TRUE(same(add(of_b.back())->payload, payload(4000, 2)));
}

TEST_F(IpReassemblyTest, DuplicatesAreCountedAndChangeNothing) {
  const Bytes data = payload(3000);
  const Bytes datagram = udp(data);
  const auto fragments = split(datagram, 1);
  EXPECT_FALSE(add(fragments[0]));
  EXPECT_FALSE(add(fragments[0]));
  EXPECT_FALSE(add(fragments[2]));
  EXPECT_FALSE(add(fragments[2]));
  EXPECT_TRUE(add(fragments[1]));
  EXPECT_EQ(counters().duplicates, 2U);
  EXPECT_EQ(counters().fragments, 5U);
}

TEST_F(IpReassemblyTest, OverlapsThatAgreeAreWelcome) {
  const Bytes data = payload(3000);
  const Bytes datagram = udp(data);
  const auto all = std::span<const std::byte>(datagram);
  IpFragment fragment = split(datagram, 1).front();
  fragment.bytes = all.first(1600);
  EXPECT_FALSE(add(fragment));
  fragment.offset = 800;
  fragment.bytes = all.subspan(800, 1600);
  EXPECT_FALSE(add(fragment));
  fragment.offset = 2000;
  fragment.bytes = all.subspan(2000);
  fragment.more = false;
  const auto whole = add(fragment);
  ASSERT_TRUE(whole);
  EXPECT_TRUE(same(whole->payload, data));
}

TEST_F(IpReassemblyTest, AContradictionBeginsANewDatagram) {
  // A sensor that gives every datagram the same identification, and a lost fragment.
  const Bytes lossy = udp(payload(3000, 1));
  const Bytes next = udp(payload(3000, 2));
  EXPECT_FALSE(add(split(lossy, 1)[0]));
  EXPECT_FALSE(add(split(lossy, 1)[1]));
  const auto whole = add_all(split(next, 1));
  ASSERT_TRUE(whole);
  EXPECT_TRUE(same(whole->payload, payload(3000, 2)));
  EXPECT_EQ(counters().dropped, 2U);
}

TEST_F(IpReassemblyTest, EndsThatDisagreeAreNotMixed) {
  const Bytes datagram = udp(payload(3000));
  auto fragments = split(datagram, 1);
  EXPECT_FALSE(add(fragments[2]));
  IpFragment other_end = fragments[1];
  other_end.more = false;
  EXPECT_FALSE(add(other_end));
  EXPECT_EQ(counters().dropped, 1U);
  EXPECT_FALSE(
      add(fragments[0]));  // the datagram that now ends after fragment 1: its UDP length says otherwise
  EXPECT_EQ(counters().reassembled, 0U);
  EXPECT_EQ(counters().dropped, 3U);
}

TEST_F(IpReassemblyTest, AWrongChecksumDropsTheDatagram) {
  Bytes datagram = udp(payload(3000));
  datagram[6] = std::byte{0x12};
  EXPECT_FALSE(add_all(split(datagram, 1)));
  EXPECT_EQ(counters().dropped, 3U);
}

TEST_F(IpReassemblyTest, WaitsOneSecondOfTheCapturesTime) {
  const Bytes datagram = udp(payload(2000));
  const auto fragments = split(datagram, 1);
  EXPECT_FALSE(add(fragments[0]));
  EXPECT_TRUE(add(fragments[1], 1'000'000'000));
  EXPECT_FALSE(add(fragments[0], 2'000'000'000));
  EXPECT_FALSE(add(fragments[1], 3'000'000'001));
  EXPECT_EQ(counters().dropped, 1U);
  EXPECT_FALSE(add(fragments[0], -5));  // the clock was set back
  EXPECT_EQ(counters().dropped, 2U);
}

TEST_F(IpReassemblyTest, TheOldestMakesRoom) {
  std::vector<Bytes> datagrams;
  for (unsigned i = 0; i < 17; ++i) datagrams.push_back(udp(payload(2000, i)));
  for (std::uint16_t i = 0; i < 17; ++i) EXPECT_FALSE(add(split(datagrams[i], i)[0], i));
  EXPECT_EQ(counters().dropped, 1U);
  for (std::uint16_t i = 1; i < 17; ++i) EXPECT_TRUE(add(split(datagrams[i], i)[1], 17)) << i;
  EXPECT_FALSE(add(split(datagrams[0], 0)[1], 17));
}

TEST_F(IpReassemblyTest, NothingReachesBeyondTheLargestDatagram) {
  const Bytes data = payload(1480);
  EXPECT_FALSE(add({.bytes = data, .offset = 65528, .more = false}));
  EXPECT_FALSE(add({.bytes = {}, .offset = 0, .more = true}));
  EXPECT_EQ(counters().dropped, 2U);
}

TEST_F(IpReassemblyTest, ClearingDropsWhatWaits) {
  const Bytes datagram = udp(payload(3000));
  EXPECT_FALSE(add(split(datagram, 1)[0]));
  reassembly_->clear();
  EXPECT_EQ(counters().dropped, 1U);
}

TEST_F(IpReassemblyTest, EveryFragmentIsAccountedFor) {
  std::mt19937_64 random(7);
  std::vector<Bytes> datagrams;
  for (unsigned i = 0; i < 40; ++i) datagrams.push_back(udp(payload(random() % 9000, i)));
  std::uint64_t used = 0;
  for (std::int64_t i = 0; i < 20000; ++i) {
    const std::size_t which = random() % datagrams.size();
    const auto fragments = split(datagrams[which], static_cast<std::uint16_t>(which % 23));
    const std::uint64_t reassembled_before = counters().reassembled;
    const auto whole = add(fragments[random() % fragments.size()], i * 100'000);
    if (counters().reassembled != reassembled_before) used += (whole->payload.size() + 8 + 1479) / 1480;
  }
  reassembly_->clear();
  EXPECT_GT(counters().reassembled, 100U);
  EXPECT_EQ(used + counters().duplicates + counters().dropped, counters().fragments);
}

}  // namespace
}  // namespace landfix::platform
