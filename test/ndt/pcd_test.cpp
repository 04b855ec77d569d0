#include "ndt/pcd.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>

namespace landfix::ndt {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

[[nodiscard]] std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

[[nodiscard]] std::vector<std::vector<double>> rows_of(const std::string& file,
                                                       std::initializer_list<std::string_view> columns) {
  std::vector<std::vector<double>> rows;
  visit_pcd(bytes_of(file), "cloud.pcd", std::vector(columns),
            [&rows](std::span<const double> row) { rows.emplace_back(row.begin(), row.end()); });
  return rows;
}

[[nodiscard]] std::string error_of(const std::string& file) {
  try {
    (void)rows_of(file, {"x", "y", "z"});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

[[nodiscard]] std::string header(const std::string& fields, const std::string& sizes,
                                 const std::string& types, std::size_t points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
         "\nDATA " + data + "\n";
}

template <class T>
void append(std::string& file, T value) {
  file.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Two points (1 2 3, ring 7) and (-4 5.5 6, ring 65535), ring first, as each kind of data.
[[nodiscard]] std::string binary_cloud() {
  std::string file = header("ring x y z", "2 4 4 4", "U F F F", 2, "binary");
  append<std::uint16_t>(file, 7);
  for (const float v : {1.0F, 2.0F, 3.0F}) append(file, v);
  append<std::uint16_t>(file, 65535);
  for (const float v : {-4.0F, 5.5F, 6.0F}) append(file, v);
  return file;
}

[[nodiscard]] std::string compressed_cloud(std::size_t copies = 1) {
  std::string columns;
  for (const std::uint16_t v : {std::uint16_t{7}, std::uint16_t{65535}}) {
    for (std::size_t i = 0; i < copies; ++i) append(columns, v);
  }
  for (const float v : {1.0F, -4.0F, 2.0F, 5.5F, 3.0F, 6.0F}) {
    for (std::size_t i = 0; i < copies; ++i) append(columns, v);
  }
  std::string packed(columns.size() + 64, '\0');
  const unsigned size = lzf_compress(columns.data(), static_cast<unsigned>(columns.size()), packed.data(),
                                     static_cast<unsigned>(packed.size()));
  std::string file = header("ring x y z", "2 4 4 4", "U F F F", 2 * copies, "binary_compressed");
  append<std::uint32_t>(file, size);
  append<std::uint32_t>(file, static_cast<std::uint32_t>(columns.size()));
  return file + packed.substr(0, size);
}

TEST(Pcd, ReadsAsciiWithBlankLinesCarriageReturnsAndComments) {
  const std::string file =
      "# a comment\r\nVERSION .7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nCOUNT 1 1 1\r\nWIDTH "
      "2\r\nHEIGHT 1\r\n"
      "POINTS 2\r\nDATA ascii\r\n1 2 3\r\n\r\n-4.5e1\t+5 6\r\n";
  EXPECT_THAT(rows_of(file, {"x", "y", "z"}), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(-45, 5, 6)));
}

TEST(Pcd, ReadsBinaryFieldsInAnyOrder) {
  EXPECT_THAT(rows_of(binary_cloud(), {"x", "y", "z", "ring"}),
              ElementsAre(ElementsAre(1, 2, 3, 7), ElementsAre(-4, 5.5, 6, 65535)));
}

TEST(Pcd, ReadsCompressedColumns) {
  const auto rows = rows_of(compressed_cloud(100), {"ring", "z", "x"});
  ASSERT_EQ(rows.size(), 200U);
  EXPECT_THAT(rows.front(), ElementsAre(7, 3, 1));
  EXPECT_THAT(rows.back(), ElementsAre(65535, 6, -4));
}

TEST(Pcd, ReadsEveryTypeAndSkipsPaddingAndFurtherElements) {
  std::string file =
      "FIELDS x y _ z i8 i16 i32 u32 histogram\nSIZE 8 4 1 4 1 2 4 4 4\nTYPE F F U F I I I U F\nCOUNT 1 1 3 "
      "1 1 1 1 1 "
      "2\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n";
  append(file, 1e6 + 0.001);
  append(file, 2.0F);
  file.append(3, 'p');
  append(file, 3.0F);
  append<std::int8_t>(file, -1);
  append<std::int16_t>(file, -300);
  append<std::int32_t>(file, -70000);
  append<std::uint32_t>(file, 4000000000U);
  append(file, 0.25F);
  append(file, 0.5F);
  EXPECT_THAT(rows_of(file, {"x", "z", "i8", "i16", "i32", "u32", "histogram"}),
              ElementsAre(ElementsAre(1e6 + 0.001, 3, -1, -300, -70000, 4e9, 0.25)));
}

TEST(Pcd, AMissingColumnIsNanButPositionsAreNeeded) {
  EXPECT_TRUE(std::isnan(rows_of(binary_cloud(), {"intensity"}).front().front()));
  EXPECT_THAT(error_of(header("x y ring", "4 4 2", "F F U", 0, "ascii")), HasSubstr("no field z"));
}

TEST(Pcd, PositionsLeaveOutPointsThatAreNotFinite) {
  const std::string file = header("x y z", "4 4 4", "F F F", 4, "ascii") + "1 2 3\nnan 0 0\n0 inf 0\n4 5 6\n";
  std::vector<Eigen::Vector3d> positions;
  visit_pcd_positions(bytes_of(file), "cloud.pcd", [&](const Eigen::Vector3d& p) { positions.push_back(p); });
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_EQ(positions[1], Eigen::Vector3d(4, 5, 6));
}

TEST(Pcd, ErrorsNameTheFileAndTheLine) {
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n1 two 3\n"),
              StartsWith("cloud.pcd: line 12: 'two'"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2\n"),
              HasSubstr("line 11: 3 numbers"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 3 4\n"),
              HasSubstr("more than 3"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "zip")), HasSubstr("line 10: DATA 'zip'"));
  EXPECT_THAT(error_of("FIELDS x y z\nPOINTS -3\n"), HasSubstr("line 2: POINTS '-3'"));
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\n"), HasSubstr("line 1: 'ply'"));
  EXPECT_THAT(error_of(""), HasSubstr("no DATA line"));
}

TEST(Pcd, RefusesHeadersThatDoNotAddUp) {
  EXPECT_THAT(error_of(header("x y z", "4 4", "F F F", 1, "ascii")), HasSubstr("3 FIELDS, but 2 SIZE"));
  EXPECT_THAT(error_of(header("x y z", "4 4 3", "F F F", 1, "ascii")),
              HasSubstr("field z: no such type as F3"));
  EXPECT_THAT(error_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n"),
              HasSubstr("POINTS 5 is not WIDTH 3 times HEIGHT 2"));
  EXPECT_THAT(error_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 99999999\nWIDTH 1\nDATA binary\n"),
              HasSubstr("COUNT"));
}

TEST(Pcd, RefusesEveryTruncation) {
  for (const std::string& whole : {binary_cloud(), compressed_cloud(), compressed_cloud(50)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_NE(error_of(whole.substr(0, size)), "no error") << size;
    }
    EXPECT_EQ(error_of(whole), "no error");
  }
}

TEST(Pcd, RefusesCountsThatTheFileCannotHoldWithoutAllocatingThem) {
  std::string file = header("x y z", "4 4 4", "F F F", 4000000000U, "binary") + std::string(24, '\0');
  EXPECT_THAT(error_of(file), HasSubstr("truncated"));
  file = header("x y z", "4 4 4", "F F F", 300000000U, "binary_compressed");
  append<std::uint32_t>(file, 8);
  append<std::uint32_t>(file, 3600000000U);
  EXPECT_THAT(error_of(file + std::string(8, '\0')), HasSubstr("damaged"));
}

}  // namespace
}  // namespace landfix::ndt
