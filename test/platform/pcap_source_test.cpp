#include "platform/pcap_source.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/pcap_writer.hpp"
#include "support/error_of.hpp"
#include "support/frames.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;
using testing::HasSubstr;

constexpr std::int64_t kStart_utc_ns = 1'700'000'000'123'456'789;
constexpr UdpFlow kFlow{.source_address = 0xC0A801C9, .source_port = 2368, .destination_port = 2369};

void write_bytes(const std::filesystem::path& path, const Bytes& data) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
}

Bytes le32(std::uint32_t value) {
  return bytes({value & 0xFF, value >> 8 & 0xFF, value >> 16 & 0xFF, value >> 24 & 0xFF});
}
Bytes le16(std::uint32_t value) { return bytes({value & 0xFF, value >> 8 & 0xFF}); }

/// A classic pcap file, little-endian, with microseconds.
Bytes pcap_file(std::uint32_t link_type, const std::vector<Bytes>& frames, std::uint32_t snapshot = 65535) {
  Bytes file = le32(0xA1B2C3D4) + le16(2) + le16(4) + le32(0) + le32(0) + le32(snapshot) + le32(link_type);
  for (std::uint32_t i = 0; const Bytes& frame : frames) {
    const auto size = static_cast<std::uint32_t>(frame.size());
    file = file + le32(1'700'000'000) + le32(i++) + le32(std::min(size, snapshot)) + le32(size) +
           Bytes(frame.begin(), frame.begin() + std::min(size, snapshot));
  }
  return file;
}

/// A pcapng file: section header, one interface with nanoseconds, enhanced packet blocks.
Bytes pcapng_file(const std::vector<Bytes>& frames, std::uint64_t first_utc_ns) {
  Bytes file = le32(0x0A0D0D0A) + le32(28) + le32(0x1A2B3C4D) + le16(1) + le16(0) +
               Bytes(8, std::byte{0xFF}) + le32(28) + le32(1) + le32(32) + le16(1) + le16(0) + le32(0) +
               le16(9) + le16(1) + bytes({9, 0, 0, 0}) + le16(0) + le16(0) + le32(32);
  for (std::uint64_t i = 0; const Bytes& frame : frames) {
    const std::uint64_t stamp = first_utc_ns + i++;
    const auto size = static_cast<std::uint32_t>(frame.size());
    const std::uint32_t padding = (4 - size % 4) % 4;
    file = file + le32(6) + le32(32 + size + padding) + le32(0) +
           le32(static_cast<std::uint32_t>(stamp >> 32)) +
           le32(static_cast<std::uint32_t>(stamp & 0xFFFFFFFF)) + le32(size) + le32(size) + frame +
           Bytes(padding) + le32(32 + size + padding);
  }
  return file;
}

std::string error_of(const std::filesystem::path& path) {
  return test::error_of([&] { return PcapSource(path); });
}

class PcapSourceTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return directory_.path() / "capture.pcap"; }

  TemporaryDirectory directory_;
};

TEST_F(PcapSourceTest, DeliversWhatTheWriterWrote) {
  PcapWriter writer(path());
  for (unsigned i = 0; i < 100; ++i) writer.write(kFlow, payload(1200 + i, i), kStart_utc_ns + i);
  writer.commit();

  PcapSource source(path());
  UdpPacket packet;
  for (unsigned i = 0; i < 100; ++i) {
    ASSERT_EQ(source.next(packet), ReadStatus::packet);
    EXPECT_TRUE(same(packet.payload, payload(1200 + i, i)));
    EXPECT_EQ(packet.receive_utc_ns, kStart_utc_ns + i);
    EXPECT_EQ(packet.source_address, kFlow.source_address);
    EXPECT_EQ(packet.source_port, 2368);
    EXPECT_EQ(packet.destination_port, 2369);
  }
  EXPECT_EQ(source.next(packet), ReadStatus::end);
  EXPECT_EQ(source.next(packet), ReadStatus::end);
  EXPECT_EQ(source.counters().records, 100U);
  EXPECT_EQ(source.counters().udp, 100U);
  EXPECT_EQ(source.percent_read(), 100.0);
}

TEST_F(PcapSourceTest, ReassemblesWhatTheWriterSplit) {
  for (const std::size_t mtu_bytes : {68U, 1500U, 9000U}) {
    PcapWriter writer(path(), mtu_bytes);
    for (unsigned i = 0; i < 5; ++i) writer.write(kFlow, payload(33024, i), kStart_utc_ns + i);
    writer.commit();

    PcapSource source(path());
    UdpPacket packet;
    for (unsigned i = 0; i < 5; ++i) {
      ASSERT_EQ(source.next(packet), ReadStatus::packet);
      EXPECT_TRUE(same(packet.payload, payload(33024, i)));
    }
    EXPECT_EQ(source.next(packet), ReadStatus::end);
    EXPECT_EQ(source.counters().reassembled, 5U);
    EXPECT_EQ(source.counters().fragments, source.counters().records);
    EXPECT_EQ(source.counters().fragments_dropped, 0U);
  }
}

TEST_F(PcapSourceTest, ReadsEveryLinkTypeOfTheFormat) {
  const Bytes data = payload(300);
  const Bytes ip = ipv4(udp(data));
  const std::vector<std::pair<std::uint32_t, Bytes>> frames{
      {1, ethernet(ip)},
      {113, Bytes(14) + be16(0x0800) + ip},
      {276, be16(0x0800) + Bytes(18) + ip},
      {101, ip},
      {228, ip},
      {0, bytes({2, 0, 0, 0}) + ip},
      {108, bytes({0, 0, 0, 2}) + ip},
  };
  for (const auto& [link_type, frame] : frames) {
    write_bytes(path(), pcap_file(link_type, {frame}));
    PcapSource source(path());
    UdpPacket packet;
    ASSERT_EQ(source.next(packet), ReadStatus::packet) << link_type;
    EXPECT_TRUE(same(packet.payload, data)) << link_type;
    EXPECT_EQ(packet.receive_utc_ns, 1'700'000'000'000'000'000) << link_type;
  }
}

TEST_F(PcapSourceTest, ReadsPcapngToTheNanosecond) {
  const Bytes data = payload(301);
  write_bytes(path(), pcapng_file({ethernet(ipv4(udp(data))), ethernet(ipv4(udp(data)))}, kStart_utc_ns));
  PcapSource source(path());
  UdpPacket packet;
  ASSERT_EQ(source.next(packet), ReadStatus::packet);
  ASSERT_EQ(source.next(packet), ReadStatus::packet);
  EXPECT_EQ(packet.receive_utc_ns, kStart_utc_ns + 1);
  EXPECT_TRUE(same(packet.payload, data));
  EXPECT_EQ(source.next(packet), ReadStatus::end);
}

TEST_F(PcapSourceTest, CountsWhatIsNotADatagram) {
  write_bytes(path(),
              pcap_file(1, {ethernet(payload(46), 0x0806), ethernet(ipv4(payload(40), {.protocol = 6})),
                            ethernet(ipv4(udp(payload(10)), {.offset = 8})), ethernet({}),
                            ethernet(ipv4(udp(payload(20))))}));
  PcapSource source(path());
  UdpPacket packet;
  EXPECT_EQ(source.next(packet), ReadStatus::packet);
  EXPECT_EQ(source.next(packet), ReadStatus::end);
  const CaptureCounters counters = source.counters();
  EXPECT_EQ(counters.records, 5U);
  EXPECT_EQ(counters.not_ip, 1U);
  EXPECT_EQ(counters.not_udp, 1U);
  EXPECT_EQ(counters.fragments, 1U);
  EXPECT_EQ(counters.fragments_dropped, 1U);
  EXPECT_EQ(counters.malformed, 1U);
  EXPECT_EQ(counters.udp, 1U);
}

TEST_F(PcapSourceTest, CountsFramesThatTheSnapshotLengthCut) {
  write_bytes(path(), pcap_file(1, {ethernet(ipv4(udp(payload(1000))))}, 96));
  PcapSource source(path());
  UdpPacket packet;
  EXPECT_EQ(source.next(packet), ReadStatus::end);
  EXPECT_EQ(source.counters().cut_short, 1U);
}

TEST_F(PcapSourceTest, StopsAtARecordThatIsCutShort) {
  const Bytes frame = ethernet(ipv4(udp(payload(100))));
  const Bytes whole = pcap_file(1, {frame, frame});
  const std::size_t record = 16 + frame.size();
  for (std::size_t size = whole.size() - record; size <= whole.size(); ++size) {
    write_bytes(path(), Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    PcapSource source(path());
    UdpPacket packet;
    EXPECT_EQ(source.next(packet), ReadStatus::packet);
    if (size == whole.size()) {
      EXPECT_EQ(source.next(packet), ReadStatus::packet);
    }
    const bool on_boundary = size == whole.size() || size == whole.size() - record;
    EXPECT_EQ(source.next(packet), on_boundary ? ReadStatus::end : ReadStatus::truncated) << size;
    EXPECT_EQ(source.next(packet), on_boundary ? ReadStatus::end : ReadStatus::truncated) << size;
    EXPECT_EQ(*source.read_error() == '\0', on_boundary) << size;
  }
}

TEST_F(PcapSourceTest, RewindsToTheFirstPacket) {
  PcapWriter writer(path());
  writer.write(kFlow, payload(10, 1), kStart_utc_ns);
  writer.write(kFlow, payload(10, 2), kStart_utc_ns + 1);
  writer.commit();
  PcapSource source(path());
  UdpPacket packet;
  for (int round = 0; round < 3; ++round) {
    ASSERT_EQ(source.next(packet), ReadStatus::packet);
    EXPECT_EQ(packet.receive_utc_ns, kStart_utc_ns);
    source.rewind();
    EXPECT_EQ(source.counters().records, 0U);
  }
}

TEST_F(PcapSourceTest, SaysWhichFileItCannotReadAndWhy) {
  EXPECT_THAT(error_of(directory_.path() / "absent.pcap"), HasSubstr("absent.pcap"));
  EXPECT_THAT(error_of(directory_.path() / "absent.pcap"), HasSubstr("No such file"));
  write_bytes(path(), payload(100));
  EXPECT_THAT(error_of(path()), HasSubstr("pcap and pcapng files are read"));
  write_bytes(path(), {});
  EXPECT_THAT(error_of(path()), HasSubstr("capture.pcap"));
  write_bytes(path(), pcap_file(105, {}));
  EXPECT_THAT(error_of(path()), HasSubstr("link type 105 (IEEE802_11) is not read"));
  EXPECT_THAT(error_of(directory_.path()), HasSubstr("directory"));
}

TEST_F(PcapSourceTest, AStampBeyondInt64IsMalformed) {
  write_bytes(path(), pcapng_file({ethernet(ipv4(udp(payload(10))))}, 0xFFFFFFFFFFFFFFFF));
  PcapSource source(path());
  UdpPacket packet;
  EXPECT_NE(source.next(packet), ReadStatus::truncated);
}

TEST_F(PcapSourceTest, ReadsRealCaptures) {
  struct Expected {
    const char* name;
    std::uint64_t data_packets;
    std::size_t data_bytes;
    std::uint64_t position_packets;
    ReadStatus end;
  };
  for (const Expected& expected :
       {Expected{"vlp16/moving.pcap", 291, 1206, 56, ReadStatus::truncated},
        Expected{"vlp16/dual-return.pcap", 603, 1206, 0, ReadStatus::end},
        Expected{"os1-64/legacy-100-packets.pcap", 100, 12608, 0, ReadStatus::end}}) {
    LANDFIX_REAL_DATA(capture, expected.name);
    PcapSource source(capture);
    UdpPacket packet;
    std::uint64_t data_packets = 0;
    std::uint64_t position_packets = 0;
    ReadStatus status{};
    while ((status = source.next(packet)) == ReadStatus::packet) {
      if (packet.payload.size() == expected.data_bytes) ++data_packets;
      if (packet.payload.size() == 512 && packet.destination_port == 8308) ++position_packets;
    }
    EXPECT_EQ(status, expected.end) << expected.name;
    EXPECT_EQ(data_packets, expected.data_packets) << expected.name;
    EXPECT_EQ(position_packets, expected.position_packets) << expected.name;
    EXPECT_EQ(source.counters().fragments_dropped, 0U) << expected.name;
    EXPECT_EQ(source.counters().malformed, 0U) << expected.name;
  }
}

}  // namespace
}  // namespace landfix::platform
