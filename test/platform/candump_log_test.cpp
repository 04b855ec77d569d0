#include "platform/candump_log.hpp"

#include <array>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "platform/pose_frames.hpp"
#include "support/send_frame.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

TEST(CandumpLog, WritesTheLinesOfCandump) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "can.log";
  CandumpLog log(path, "can0");
  PoseReport report;
  report.x_m = 1234.567;
  report.y_m = -89.012;
  EXPECT_TRUE(
      test::send_frame(log, encode_frame(kFrameLayouts[0], 0x3A0, 3, report), 1'700'000'000'123'456'789));
  EXPECT_TRUE(test::send_frame(log, {.id = 0x12345, .extended = true, .length = 2, .data = {std::byte{0xAB}}},
                               1'000));
  EXPECT_TRUE(test::send_frame(log, {.id = 0x3A9, .fd = true, .bit_rate_switch = true, .length = 12}, 2'000));
  EXPECT_TRUE(test::send_frame(log, {.id = 0x3A9, .fd = true, .length = 0}, 3'000));
  EXPECT_FALSE(std::filesystem::exists(path));
  log.commit();
  EXPECT_EQ(test::text_of(path),
            "(1700000000.123456) can0 3A0#471387D6124CA4FE\n"
            "(0.000001) can0 00012345#AB00\n"
            "(0.000002) can0 3A9##1000000000000000000000000\n"
            "(0.000003) can0 3A9##0\n");
}

TEST(CandumpLog, TheParserReadsWhatTheLogWrote) {
  const test::TemporaryDirectory directory;
  CandumpLog log(directory.path() / "can.log", "vcan12");
  const std::array frames{
      CanFrame{.id = 0x7FF, .length = 8, .data = {std::byte{1}, std::byte{0xFE}}},
      CanFrame{.id = 0x7FF, .fd = true, .bit_rate_switch = true, .length = 64, .data = {std::byte{2}}},
      CanFrame{.id = 0x1FFFFFFF, .extended = true, .fd = true, .length = 1, .data = {std::byte{3}}},
  };
  for (const CanFrame& frame : frames) EXPECT_TRUE(test::send_frame(log, frame, 1'700'000'000'123'456'000));
  log.commit();
  std::ifstream file(directory.path() / "can.log");
  for (const CanFrame& frame : frames) {
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    const auto logged = parse_candump_line(line);
    ASSERT_TRUE(logged) << line;
    EXPECT_EQ(logged->stamp_utc_ns, 1'700'000'000'123'456'000);
    EXPECT_EQ(logged->interface, "vcan12");
    EXPECT_EQ(logged->frame, frame);
  }
}

TEST(CandumpLog, ANameThatWouldBreakTheLinesIsRefused) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"", "can 0", "can0\n", "a/b", "sixteencharacter"}) {
    EXPECT_THROW(CandumpLog(directory.path() / "can.log", name), std::runtime_error) << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(CandumpLine, ReadsTheVariantsOfTheFormat) {
  EXPECT_EQ(parse_candump_line("(1.5) can0 123#")->frame.length, 0);
  EXPECT_EQ(parse_candump_line("(1.5) can0 123#")->stamp_utc_ns, 1'500'000'000);
  EXPECT_EQ(parse_candump_line("(1.000000001) can0 123#00")->stamp_utc_ns, 1'000'000'001);
  EXPECT_EQ(parse_candump_line("(1.5) can0 123#aB.cd.EF R\r\n")->frame.length, 3);
  EXPECT_TRUE(parse_candump_line("(1.5) can0 1FFFFFFF#00 T")->frame.extended);
  EXPECT_TRUE(parse_candump_line("(1.5) can0 123##5AB")->frame.bit_rate_switch);  // and the newer flag FDF
  EXPECT_FALSE(parse_candump_line("(1.5) can0 123##2AB")->frame.bit_rate_switch);
  EXPECT_EQ(parse_candump_line("(1.5) can0 123##0")->frame.length, 0);
}

TEST(CandumpLine, NothingElseIsAFrame) {
  for (const char* line : {"",
                           "(",
                           "(1.5)",
                           "(1.5) can0",
                           "(1.5) can0 123",
                           "1.5 can0 123#00",
                           "(1.5) can0 12#00",
                           "(1.5) can0 800#00",
                           "(1.5) can0 20000000#00",
                           "(1.5) can0 123#0",
                           "(1.5) can0 123#001",
                           "(1.5) can0 123#0G",
                           "(1.5) can0 123#-1",
                           "(1.5) can0 123#001122334455667788",
                           "(1.5) can0 123#R",
                           "(1.5) can0 123##",
                           "(1.5) can0 123##G00",
                           "(1.5) can0 123##1000",
                           "(1.5) can0 123##1001122334455667788",
                           "(-1.5) can0 123#00",
                           "(1.) can0 123#00",
                           "(1.0000000001) can0 123#00",
                           "(99999999999.0) can0 123#00",
                           "(1.5)  123#00",
                           "(1.5) can0 123#00.",
                           "(1.5) can0 -12#00"}) {
    EXPECT_FALSE(parse_candump_line(line)) << line;
  }
}

}  // namespace
}  // namespace landfix::platform
