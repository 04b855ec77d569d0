#include "platform/pcd_writer.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ndt/pcd.hpp"
#include "ndt/pcd_header.hpp"
#include "platform/atomic_file.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

std::vector<std::vector<double>> read(const std::filesystem::path& path,
                                      std::span<const std::string_view> columns) {
  std::vector<std::vector<double>> rows;
  ndt::visit_pcd(read_file(path), path.string(), columns, [&rows](std::span<const double> values) {
    rows.emplace_back(values.begin(), values.end());
  });
  return rows;
}

TEST(PcdWriter, WritesEveryFieldOfAPoint) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "0000.pcd";
  const std::vector<drivers::Point> points{
      {.x = 1.5F, .y = -2.5F, .z = 3.25F, .intensity = 255.0F, .time_s = 0.0625F, .ring = 63},
      {.x = -1e-3F, .y = 1e5F, .z = 0.0F, .intensity = 0.0F, .time_s = 0.0F, .ring = 0}};
  write_pcd<drivers::Point>(path, kPointMembers, points);
  constexpr std::string_view kColumns[] = {"x", "y", "z", "intensity", "ring", "time"};
  const auto rows = read(path, kColumns);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0], (std::vector<double>{1.5, -2.5, 3.25, 255.0, 63.0, 0.0625}));
  EXPECT_EQ(rows[1][1], 1e5);
  const auto header = ndt::read_pcd_header(read_file(path), path.string());
  EXPECT_EQ(header.point_size, 22U) << "packed: five F4 and one U2";
  EXPECT_EQ(header.data, ndt::PcdHeader::Data::binary);
}

TEST(PcdWriter, WritesAnEmptyCloud) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "empty.pcd";
  write_pcd<drivers::Point>(path, kPointMembers, {});
  EXPECT_EQ(ndt::read_pcd_header(read_file(path), path.string()).points, 0U);
}

TEST(PcdStream, WritesWhatTheWholeCloudAtOnceWouldBe) {
  const test::TemporaryDirectory directory;
  const std::vector<std::array<float, 3>> points{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, {7.0F, 8.0F, 9.0F}};
  write_pcd<std::array<float, 3>>(directory.path() / "whole.pcd", kPositionMembers, points);
  PcdStream stream(directory.path() / "stream.pcd", kPositionMembers);
  for (const auto& point : points) stream.write(std::as_bytes(std::span(point)));
  stream.commit();
  EXPECT_EQ(read_file(directory.path() / "stream.pcd"), read_file(directory.path() / "whole.pcd"));
}

TEST(PcdStream, LeavesNoFileWhoseLastPointIsNotWhole) {
  const test::TemporaryDirectory directory;
  {
    PcdStream stream(directory.path() / "torn.pcd", kPositionMembers);
    constexpr std::array<float, 4> kPointAndAThird{1.0F, 2.0F, 3.0F, 4.0F};
    stream.write(std::as_bytes(std::span(kPointAndAThird)));
    EXPECT_THROW(stream.commit(), std::logic_error);
  }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(PcdWriter, SaysWhereItCannotWrite) {
  EXPECT_THROW(write_pcd<drivers::Point>("/nonexistent/0000.pcd", kPointMembers, {}), std::runtime_error);
}

}  // namespace
}  // namespace landfix::platform
