#include "platform/udp_frame.hpp"

#include <gtest/gtest.h>

#include "support/frames.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

Frame parse(LinkType link, const Bytes& frame) { return parse_frame(link, frame, frame.size()); }

void expect_payload(const Frame& frame, const Bytes& expected) {
  ASSERT_EQ(frame.status, FrameStatus::udp);
  EXPECT_TRUE(same(frame.udp.payload, expected));
  EXPECT_EQ(frame.udp.source_port, 2368);
  EXPECT_EQ(frame.udp.destination_port, 2369);
}

TEST(UdpFrame, EveryLinkTypeGivesTheSameDatagram) {
  const Bytes data = payload(1206);
  const Bytes ip = ipv4(udp(data));
  const Bytes cooked(14, std::byte{0});
  expect_payload(parse(LinkType::ethernet, ethernet(ip)), data);
  expect_payload(parse(LinkType::linux_cooked, cooked + be16(0x0800) + ip), data);
  expect_payload(parse(LinkType::linux_cooked2, be16(0x0800) + Bytes(18) + ip), data);
  expect_payload(parse(LinkType::raw_ip, ip), data);
  expect_payload(parse(LinkType::loopback, bytes({2, 0, 0, 0}) + ip), data);
  EXPECT_EQ(parse(LinkType::raw_ip, ip).udp.source_address, 0xC0A801C9U);
}

TEST(UdpFrame, VlanTagsMayBeStacked) {
  const Bytes data = payload(100);
  const Bytes inner = be16(7) + be16(0x0800) + ipv4(udp(data));
  expect_payload(parse(LinkType::ethernet, ethernet(inner, 0x8100)), data);
  expect_payload(parse(LinkType::ethernet, ethernet(be16(9) + be16(0x8100) + inner, 0x88A8)), data);
  EXPECT_EQ(parse(LinkType::ethernet, ethernet(be16(7) + be16(0x8100), 0x8100)).status,
            FrameStatus::malformed);
}

TEST(UdpFrame, HeaderOptionsAndPaddingAreNotPayload) {
  const Bytes data = payload(4);
  const Bytes with_options = ipv4(udp(data), {.options = Bytes(40, std::byte{1})});
  expect_payload(parse(LinkType::ethernet, ethernet(with_options) + Bytes(14, std::byte{0xAA})), data);
  // A UDP length that is shorter than the IP payload, and an empty payload.
  expect_payload(parse(LinkType::raw_ip, ipv4(udp(data) + Bytes(6))), data);
  expect_payload(parse(LinkType::raw_ip, ipv4(udp({}))), {});
}

TEST(UdpFrame, Ipv6IsRead) {
  const Bytes data = payload(50);
  const Bytes on_wire = ethernet(ipv6(udp(data)), 0x86DD);
  const Frame frame = parse(LinkType::ethernet, on_wire);
  expect_payload(frame, data);
  EXPECT_EQ(frame.udp.source_address, 0U);
  EXPECT_EQ(parse(LinkType::raw_ip, ipv6(udp(data), 44)).status, FrameStatus::not_udp);
}

TEST(UdpFrame, WhatIsNotUdpSaysSo) {
  EXPECT_EQ(parse(LinkType::ethernet, ethernet(payload(46), 0x0806)).status, FrameStatus::not_ip);
  EXPECT_EQ(parse(LinkType::raw_ip, ipv4(payload(20), {.protocol = 6})).status, FrameStatus::not_udp);
  EXPECT_EQ(parse(LinkType::raw_ip, bytes({0x55, 0, 0, 0})).status, FrameStatus::malformed);
}

TEST(UdpFrame, LengthsThatContradictTheFrameAreMalformed) {
  Bytes short_header = ipv4(udp(payload(10)));
  short_header[0] = std::byte{0x44};
  EXPECT_EQ(parse(LinkType::raw_ip, short_header).status, FrameStatus::malformed);

  Bytes total_below_header = ipv4(udp(payload(10)));
  total_below_header[3] = std::byte{19};
  EXPECT_EQ(parse(LinkType::raw_ip, total_below_header).status, FrameStatus::malformed);

  for (const unsigned udp_bytes : {0U, 7U, 19U, 65535U}) {
    Bytes frame = ipv4(udp(payload(10)));
    frame[24] = static_cast<std::byte>(udp_bytes >> 8);
    frame[25] = static_cast<std::byte>(udp_bytes & 0xFF);
    EXPECT_EQ(parse(LinkType::raw_ip, frame).status, FrameStatus::malformed) << udp_bytes;
  }
}

TEST(UdpFrame, TheUdpLengthDecidesWhereTheIpLengthIsTooLarge) {
  // As a VLP-16 sends its position packets.
  Bytes frame = ipv4(udp(payload(512)));
  frame[2] = std::byte{0x04};
  frame[3] = std::byte{0xD2};
  expect_payload(parse(LinkType::raw_ip, frame), payload(512));
}

TEST(UdpFrame, EveryTruncationIsRefusedAndSaysWhoseFaultItIs) {
  const Bytes frame = ethernet(ipv4(udp(payload(64))));
  for (std::size_t size = 0; size < frame.size(); ++size) {
    const std::span<const std::byte> start = std::span(frame).first(size);
    EXPECT_EQ(parse_frame(LinkType::ethernet, start, size).status, FrameStatus::malformed) << size;
    EXPECT_EQ(parse_frame(LinkType::ethernet, start, frame.size()).status, FrameStatus::cut_short) << size;
  }
}

TEST(UdpFrame, FragmentsCarryWhereTheyBelong) {
  const Bytes data = payload(1480);
  const Bytes on_wire = ipv4(data, {.identification = 0xABCD, .offset = 2960, .more = true});
  const Frame frame = parse(LinkType::raw_ip, on_wire);
  ASSERT_EQ(frame.status, FrameStatus::fragment);
  EXPECT_TRUE(same(frame.fragment.bytes, data));
  EXPECT_EQ(frame.fragment.identification, 0xABCD);
  EXPECT_EQ(frame.fragment.offset, 2960U);
  EXPECT_TRUE(frame.fragment.more);
  // Only the last may end within a unit of 8 bytes, and none is empty.
  EXPECT_EQ(parse(LinkType::raw_ip, ipv4(payload(13), {.more = true})).status, FrameStatus::malformed);
  EXPECT_EQ(parse(LinkType::raw_ip, ipv4(payload(13), {.offset = 8})).status, FrameStatus::fragment);
  EXPECT_EQ(parse(LinkType::raw_ip, ipv4({}, {.offset = 8})).status, FrameStatus::malformed);
}

}  // namespace
}  // namespace landfix::platform
