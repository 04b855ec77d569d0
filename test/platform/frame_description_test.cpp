#include "platform/frame_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/atomic_file.hpp"
#include "platform/configuration.hpp"
#include "platform/pose_frame_table.hpp"

namespace landfix::platform {
namespace {

std::string text_of(const char* name) {
  const auto bytes = read_file(std::filesystem::path(LANDFIX_CONFIG_FOLDER) / name);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(FrameDescription, TheCommittedDbcIsTheGeneratedOne) {
  EXPECT_EQ(text_of("landfix.dbc"), to_dbc(CanSettings{}.base_id)) << "landfix can dbc > config/landfix.dbc";
}

TEST(FrameDescription, TheTableOfTheReadmeIsTheGeneratedOne) {
  EXPECT_NE(text_of("../README.md").find(to_markdown()), std::string::npos) << "landfix can table";
}

TEST(FrameDescription, FollowsTheBaseId) {
  EXPECT_THAT(to_dbc(0x100), testing::HasSubstr("BO_ 256 LOC_POSITION: 8 LANDFIX\n"));
  EXPECT_THAT(to_dbc(0x100), testing::HasSubstr("BO_ 265 LOC_POSE: 64 LANDFIX\n"));
}

// Names of more than 32 characters and anything but ASCII do not survive every tool.
TEST(FrameDescription, IsWhatOldToolsCanRead) {
  for (const char c : to_dbc(0x3A0)) ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F));
  for (const FrameLayout& layout : kFrameLayouts) {
    EXPECT_LE(layout.name.size() + 4, 32U);  // and _CRC
    for (const Signal& signal : layout.signals) EXPECT_LE(signal.name.size(), 32U);
  }
}

}  // namespace
}  // namespace landfix::platform
