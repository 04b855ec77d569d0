#include "platform/saved_pose.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

class SavedPoseFile : public ::testing::Test {
 protected:
  void write(const char* text) const { std::ofstream(path) << text; }

  const test::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "pose.toml";
};

TEST_F(SavedPoseFile, ComesBack) {
  SavedPose saved{.at = {.stamp_utc_ns = 1'700'000'000'123'456'789}, .map_checksum = 0xFEDCBA98};
  saved.at.pose =
      ndt::make_pose({1234.5, -0.25, 56.75}, {.roll_rad = 0.01, .pitch_rad = -0.02, .yaw_rad = 3.0});
  save_pose(path, saved);
  const SavedPose read = read_saved_pose(path);
  EXPECT_EQ(read.at.stamp_utc_ns, saved.at.stamp_utc_ns);
  EXPECT_EQ(read.map_checksum, saved.map_checksum);
  EXPECT_LT((read.at.pose.matrix() - saved.at.pose.matrix()).norm(), 1e-4);
}

TEST_F(SavedPoseFile, IsRefusedWhereItIsNotOne) {
  write("[saved]\npose = [1, 2, 3]\nmap_checksum = 1\n");
  EXPECT_NE(test::error_of([&] { (void)read_saved_pose(path); }).find("saved.pose"), std::string::npos);
  write("[saved]\npose = [1, 2, 3, 0, 0, 0]\n");
  EXPECT_NE(test::error_of([&] { (void)read_saved_pose(path); }).find("map_checksum"), std::string::npos);
  write("[sav");
  EXPECT_NE(test::error_of([&] { (void)read_saved_pose(path); }).find("pose.toml"), std::string::npos);
  std::filesystem::remove(path);
  EXPECT_NE(test::error_of([&] { (void)read_saved_pose(path); }).find("pose.toml"), std::string::npos);
}

}  // namespace
}  // namespace landfix::platform
