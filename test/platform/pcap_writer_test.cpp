#include "platform/pcap_writer.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "platform/internet_checksum.hpp"
#include "support/frames.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using namespace landfix::test;

constexpr UdpFlow kWrittenFlow{.source_address = 0xC0A801C9,
                               .destination_address = 0xC0A80101,
                               .source_port = 2368,
                               .destination_port = 2368};

TEST(InternetChecksum, IsThatOfTheStandard) {
  // The worked example of RFC 1071, section 3: the sum is ddf2.
  InternetChecksum checksum;
  checksum.add(bytes({0x00, 0x01, 0xF2, 0x03, 0xF4, 0xF5, 0xF6, 0xF7}));
  EXPECT_EQ(checksum.value(), 0xFFFF - 0xDDF2);
}

TEST(PcapWriter, WritesTheHeadersOfTheFormats) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a.pcap";
  PcapWriter writer(path);
  writer.write(kWrittenFlow, bytes({'l', 'i', 'd', 'a', 'r'}), 1'700'000'000'000'000'042);
  writer.commit();
  const Bytes expected =
      bytes({0xA1, 0xB2, 0x3C, 0x4D, 0, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 1}) +
      bytes({0x65, 0x53, 0xF1, 0x00, 0, 0, 0, 42, 0, 0, 0, 47, 0, 0, 0, 47}) +
      bytes({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 2, 0, 192, 168, 1, 201, 0x08, 0x00}) +
      bytes({0x45, 0, 0, 33, 0, 0, 0, 0, 64, 17, 0xF6, 0xB1, 192, 168, 1, 201, 192, 168, 1, 1}) +
      bytes({0x09, 0x40, 0x09, 0x40, 0, 13, 0x26, 0x6E}) + bytes({'l', 'i', 'd', 'a', 'r'});
  EXPECT_EQ(read_file(path), expected);
}

TEST(PcapWriter, LeavesNothingBehindUnlessCommitted) {
  const TemporaryDirectory directory;
  {
    PcapWriter writer(directory.path() / "a.pcap");
    writer.write(kWrittenFlow, payload(100), 0);
  }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(PcapWriter, RefusesWhatTheFormatsCannotHold) {
  const TemporaryDirectory directory;
  PcapWriter writer(directory.path() / "a.pcap");
  EXPECT_THROW(writer.write(kWrittenFlow, payload(65508), 0), std::runtime_error);
  EXPECT_THROW(writer.write(kWrittenFlow, payload(10), -1), std::runtime_error);
  EXPECT_THROW(writer.write(kWrittenFlow, payload(10), std::int64_t{1} << 62), std::runtime_error);
  EXPECT_THROW(PcapWriter(directory.path() / "b.pcap", 67), std::runtime_error);
}

}  // namespace
}  // namespace landfix::platform
