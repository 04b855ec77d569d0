// What the sensors say about themselves, against the worked examples of the manuals.
#include <gtest/gtest.h>

#include "drivers/robosense/device_info.hpp"
#include "support/robosense_packets.hpp"

namespace landfix::drivers::robosense {
namespace {

using test::RobosenseDeviceInfo;

DeviceInfo read(const Description& model, const RobosenseDeviceInfo& packet,
                DecodeStatus expected = DecodeStatus::telemetry) {
  DeviceInfo info;
  EXPECT_EQ(read_device_info(model, packet.bytes(), info), expected);
  return info;
}

TEST(RobosenseDeviceInfo, ReadsTheManualsExamples) {
  RobosenseDeviceInfo packet = test::robosense_unit("rs32");
  packet.set_byte(468, 0x01);  // 01 28 29
  packet.set_byte(469, 0x28);
  packet.set_byte(470, 0x29);
  packet.set_byte(564 + 27, 0x01);  // 01 0A 70
  packet.set_byte(564 + 28, 0x0A);
  packet.set_byte(564 + 29, 0x70);
  const DeviceInfo info = read(kRs32, packet);
  ASSERT_TRUE(info.angles);
  EXPECT_DOUBLE_EQ((*info.angles)[0].elevation_deg, -10.281);
  EXPECT_DOUBLE_EQ((*info.angles)[9].azimuth_offset_deg, -2.672);
  EXPECT_DOUBLE_EQ((*info.angles)[0].azimuth_offset_deg, 8.0);
  EXPECT_EQ(info.motor_rpm, 600U);
}

TEST(RobosenseDeviceInfo, ReadsRs16AnglesAsTheManualDoes) {
  RobosenseDeviceInfo packet = test::robosense_unit("rs16");
  packet.set_byte(1165 + 3 * 15, 0x00);  // 00 27 10: slot 16 looks 1 deg up
  packet.set_byte(1165 + 3 * 15 + 1, 0x27);
  packet.set_byte(1165 + 3 * 15 + 2, 0x10);
  const DeviceInfo info = read(kRs16, packet);
  ASSERT_TRUE(info.angles);
  EXPECT_DOUBLE_EQ((*info.angles)[15].elevation_deg, 1.0);
  EXPECT_DOUBLE_EQ((*info.angles)[0].elevation_deg, -15.0);
  EXPECT_DOUBLE_EQ((*info.angles)[7].elevation_deg, -1.0);
  EXPECT_DOUBLE_EQ((*info.angles)[8].elevation_deg, 15.0);
  EXPECT_DOUBLE_EQ((*info.angles)[3].azimuth_offset_deg, 0.0);
}

TEST(RobosenseDeviceInfo, CountsHeliosAnglesInHundredths) {
  const DeviceInfo info = read(kHelios16p, test::robosense_unit("helios16p"));
  ASSERT_TRUE(info.angles);
  EXPECT_DOUBLE_EQ((*info.angles)[15].elevation_deg, -15.0);
  EXPECT_DOUBLE_EQ((*info.angles)[1].azimuth_offset_deg, 3.6);
}

TEST(RobosenseDeviceInfo, SeesThatAUnitIsNotProgrammed) {
  for (const char* const model : {"rs32", "rs16", "helios16p"}) {
    const Description& description = model == std::string_view("rs32")   ? kRs32
                                     : model == std::string_view("rs16") ? kRs16
                                                                         : kHelios16p;
    EXPECT_FALSE(read(description, RobosenseDeviceInfo()).angles) << model << ": zeros";
    RobosenseDeviceInfo erased = test::robosense_unit(model);
    const std::size_t first = description.angles.vertical_at + 15;  // the sixth
    for (std::size_t at = first; at < first + 3; ++at) erased.set_byte(at, 0xFF);
    EXPECT_FALSE(read(description, erased).angles) << model << ": one laser is erased";
  }
}

TEST(RobosenseDeviceInfo, RefusesAnotherModels) {
  // These two keep their angles at other places; their data packets are alike, so it is this that tells.
  static_cast<void>(read(kRs16, test::robosense_unit("rs32"), DecodeStatus::wrong_model));
  static_cast<void>(read(kRs32, test::robosense_unit("rs16"), DecodeStatus::wrong_model));
  static_cast<void>(read(kHelios16p, test::robosense_unit("rs32"), DecodeStatus::wrong_model));
  RobosenseDeviceInfo helios = test::robosense_unit("helios16p");
  for (std::size_t i = 16; i < 32; ++i) helios.set_vertical(i, -1500 - 200 * static_cast<int>(i));
  static_cast<void>(read(kRs32, helios, DecodeStatus::wrong_model));
}

TEST(RobosenseDeviceInfo, KnowsTheFirmwareThatCountsCentimetres) {
  for (const unsigned version : {0x000000U, 0xFFFFFFU, 0x55AA5AU, 0xE90100U}) {
    RobosenseDeviceInfo packet = test::robosense_unit("rs32");
    packet.set_top_firmware(version);
    EXPECT_TRUE(read(kRs32, packet).counts_centimetres) << version;
    EXPECT_FALSE(read(kHelios16p, packet, DecodeStatus::wrong_model).counts_centimetres);
  }
  EXPECT_FALSE(read(kRs32, test::robosense_unit("rs32")).counts_centimetres);
}

TEST(RobosenseDeviceInfo, BelievesTheReturnModeOfNewFirmwareOnly) {
  RobosenseDeviceInfo packet = test::robosense_unit("rs16");
  EXPECT_EQ(read(kRs16, packet).dual_return, false);
  packet.set_return_mode(0);
  EXPECT_EQ(read(kRs16, packet).dual_return, true);
  packet.set_bottom_firmware(0x080209);
  EXPECT_EQ(read(kRs16, packet).dual_return, true);
  packet.set_bottom_firmware(0x080208);
  EXPECT_EQ(read(kRs16, packet).dual_return, std::nullopt);
}

TEST(RobosenseDeviceInfo, RefusesWhatIsNone) {
  RobosenseDeviceInfo tail = test::robosense_unit("rs32");
  tail.set_byte(1247, 0xF1);
  static_cast<void>(read(kRs32, tail, DecodeStatus::wrong_header));
  RobosenseDeviceInfo speed = test::robosense_unit("rs32");
  speed.set_rpm(40'000);
  static_cast<void>(read(kRs32, speed, DecodeStatus::wrong_header));
  DeviceInfo info;
  const RobosenseDeviceInfo sound = test::robosense_unit("rs32");
  EXPECT_EQ(read_device_info(kRs32, sound.bytes().first(1247), info), DecodeStatus::wrong_size);
  EXPECT_FALSE(is_device_info({}));
  EXPECT_FALSE(is_device_info(sound.bytes().first(7)));
  EXPECT_TRUE(is_device_info(sound.bytes()));
}

}  // namespace
}  // namespace landfix::drivers::robosense
