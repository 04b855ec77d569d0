#include "platform/dbc_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  return test::error_of([&] { return parse_dbc(text, "car.dbc"); });
}

TEST(DbcFile, ReadsMessagesAndSignals) {
  const auto messages = parse_dbc(
      "VERSION \"\"\r\n\r\nBU_: ESP\r\n"
      "BO_ 170 WHEEL_SPEEDS: 8 ESP\r\n"
      " SG_ WHEEL_FR : 6|15@0+ (0.01,-67.67) [0|250] \"kph\" XXX\r\n"
      "BO_ 2566844885 FAR: 64 ESP\n"
      " SG_ KIND M : 0|4@1+ (1,0) [0|15] \"\" XXX\n"
      " SG_ YAW m2 : 8|12@1- (-0.0014,+2.86) [-3|3] \"rad/s\" A,B\n"
      "CM_ BO_ 170 \"a comment with\n"
      "BO_ 1 NO_MESSAGE: in it\n"
      "and an end\";\n",
      "car.dbc");
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].name, "WHEEL_SPEEDS");
  EXPECT_EQ(messages[0].id, 170U);
  EXPECT_FALSE(messages[0].extended);
  EXPECT_EQ(messages[0].bytes, 8U);
  ASSERT_EQ(messages[0].signals.size(), 1U);
  const DbcSignal& wheel = messages[0].signals[0];
  EXPECT_EQ(wheel.name, "WHEEL_FR");
  EXPECT_EQ(wheel.field.start, 6U);
  EXPECT_EQ(wheel.field.length, 15U);
  EXPECT_TRUE(wheel.field.motorola);
  EXPECT_FALSE(wheel.field.is_signed);
  EXPECT_EQ(wheel.scale, 0.01);
  EXPECT_EQ(wheel.offset, -67.67);
  EXPECT_EQ(wheel.unit, "kph");
  EXPECT_TRUE(messages[1].extended);
  EXPECT_EQ(messages[1].id, 0x18FEF1D5U);
  ASSERT_EQ(messages[1].signals.size(), 2U);
  EXPECT_FALSE(messages[1].signals[0].multiplexed);
  EXPECT_TRUE(messages[1].signals[1].multiplexed);
  EXPECT_TRUE(messages[1].signals[1].field.is_signed);
  EXPECT_EQ(messages[1].signals[1].offset, 2.86);
}

TEST(DbcFile, ReadsOurOwn) {
  const auto messages = read_dbc(std::filesystem::path(LANDFIX_CONFIG_FOLDER) / "landfix.dbc");
  EXPECT_GE(messages.size(), 8U);
  EXPECT_EQ(messages[0].name, "LOC_POSITION");
}

TEST(DbcFile, SaysWhereItIsWrong) {
  const std::string message = "BO_ 1 A: 2 X\n";
  EXPECT_THAT(error_of("\nBO_ x A: 8 B\n"), HasSubstr("car.dbc:2: expected BO_ ID NAME: BYTES SENDER"));
  EXPECT_THAT(error_of("SG_ S : 0|8@1+ (1,0) [0|1] \"\" X\n"), HasSubstr("car.dbc:1: a signal before"));
  EXPECT_THAT(error_of(message + "SG_ S : 0|8@2+ (1,0) [0|1] \"\" X\n"),
              HasSubstr("car.dbc:2: expected SG_"));
  EXPECT_THAT(error_of(message + "SG_ S : 9|8@1+ (1,0) [0|1] \"\" X\n"), HasSubstr("S does not fit"));
  EXPECT_THAT(error_of(message + "SG_ S : 0|0@1+ (1,0) [0|1] \"\" X\n"), HasSubstr("1 to 64 bits"));
  EXPECT_THAT(error_of(message + "SG_ S : 0|8@1+ (0,0) [0|1] \"\" X\n"), HasSubstr("not 0"));
  EXPECT_THAT(error_of(message + "SG_ S : 0|8@1+ (inf,0) [0|1] \"\" X\n"), HasSubstr("finite"));
  EXPECT_THAT(error_of(message + "SG_ S : 0|8@1+ (1,0) [0|1] \"\n"), HasSubstr("expected SG_"));
}

}  // namespace
}  // namespace landfix::platform
