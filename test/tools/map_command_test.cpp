#include <array>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ndt/voxel_map.hpp"
#include "platform/pcd_writer.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools {
namespace {

using testing::HasSubstr;

struct Point {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

constexpr std::array kPointMembers = {
    platform::PcdMember{.name = "x", .size = 8, .offset = offsetof(Point, x)},
    platform::PcdMember{.name = "y", .size = 8, .offset = offsetof(Point, y)},
    platform::PcdMember{.name = "z", .size = 8, .offset = offsetof(Point, z)},
};

class MapCommand : public testing::Test {
 protected:
  /// Three thousand points of the ground, from (x, y) on, 10 m each way.
  [[nodiscard]] static std::vector<Point> ground_from(double x_m, double y_m) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place_m(0.0, 10.0);
    std::vector<Point> points;
    for (int i = 0; i < 3000; ++i) points.push_back({x_m + place_m(random), y_m + place_m(random), 0.5});
    return points;
  }
  void write(const std::string& name, const std::vector<Point>& points) const {
    platform::write_pcd<Point>(directory_.path() / name, kPointMembers, points);
  }
  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream(directory_.path() / name) << text;
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (directory_.path() / name).string();
  }

  [[nodiscard]] test::Outcome map(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"map", "--output", path("map.ndt"), "--json", "--pcd"});
    return test::run_landfix(more);
  }
  [[nodiscard]] nlohmann::json map_of(const std::vector<std::string>& more) const {
    const test::Outcome outcome = map(more);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return outcome.code == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
  }
  void expect_refused(const std::string& reason) const {
    const test::Outcome outcome = map({path("")});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.error, HasSubstr(reason));
  }

  test::TemporaryDirectory directory_;
};

TEST_F(MapCommand, ReadsFilesAndFolders) {
  std::filesystem::create_directory(path("more"));
  write("a.pcd", ground_from(0, 0));
  write("more/b.pcd", ground_from(20, 0));
  write("more/c.pcd", ground_from(40, 0));
  EXPECT_EQ(map_of({path("a.pcd"), path("more")})["points"], 9000);
}

TEST_F(MapCommand, OfAutowaresFolderItReadsTheTilesThatTheMetadataLists) {
  std::filesystem::create_directory(path("pointcloud_map"));
  write("pointcloud_map/a.pcd", ground_from(0, 0));
  write("b.pcd", ground_from(20, 0));
  write("not_listed.pcd", ground_from(40, 0));
  write_text("pointcloud_map_metadata.yaml",
             "x_resolution: 20.0\ny_resolution: 20.0\na.pcd: [0, 0]\nb.pcd: [20, 0]\n");
  EXPECT_EQ(map_of({path("")})["points"], 6000);
}

TEST_F(MapCommand, SaysWhatIsWrongWithAutowaresMetadata) {
  const std::string resolutions = "x_resolution: 20.0\ny_resolution: 20.0\n";
  write("a.pcd", ground_from(0, 0));
  const auto expect = [&](const std::string& text, const std::string& reason) {
    write_text("pointcloud_map_metadata.yaml", text);
    expect_refused(reason);
  };
  expect(resolutions + "a.pcd: [0, 0]\nb.pcd: [20, 0]\n", "metadata.yaml:4:1: tile b.pcd is missing");
  expect(resolutions + "a.pcd: [0, north]\n", "metadata.yaml:3:1: tile a.pcd: its corner is not [x, y]");
  expect(resolutions + "a.pcd: 5\n", "metadata.yaml:3:1: tile a.pcd: its corner is not [x, y]");
  expect(resolutions, "it lists no tile");
  expect("x_resolution: 20\na.pcd: [0, 0]\n", "no y_resolution");
  expect("x_resolution: -1\ny_resolution: 20\na.pcd: [0, 0]\n", "x_resolution is not a positive length");
  expect("a.pcd: [0, 0\n", "metadata.yaml:2:1");
  expect("- a.pcd\n", "expected x_resolution");
  expect("", "expected x_resolution");
}

TEST_F(MapCommand, AnOriginIsAddedWithoutLoss) {
  constexpr double kEast_m = 1'234'568.0;
  constexpr double kNorth_m = -2'345'676.0;
  // As it is, in double precision, and in single precision from an origin.
  std::vector<Point> points = ground_from(0, 0);
  std::vector<std::array<float, 3>> from_origin;
  for (Point& point : points) {
    point.x = std::round(point.x * 1024) / 1024;
    point.y = std::round(point.y * 1024) / 1024;
    from_origin.push_back({static_cast<float>(point.x), static_cast<float>(point.y), 0.5F});
    point.x += kEast_m;
    point.y += kNorth_m;
  }
  write("absolute.pcd", points);
  platform::write_pcd<std::array<float, 3>>(path("relative.pcd"), platform::kPositionMembers, from_origin);

  (void)map_of({path("absolute.pcd")});
  const ndt::MapImage absolute = load_map_file(path("map.ndt"));
  (void)map_of({path("relative.pcd"), "--origin", "1234568,-2345676,0"});
  const ndt::MapImage relative = load_map_file(path("map.ndt"));
  EXPECT_TRUE(std::ranges::equal(absolute.bytes(), relative.bytes()));
  EXPECT_EQ(ndt::VoxelMap(relative.bytes()).voxels().size(), 100U);
}

TEST_F(MapCommand, NeverTakesThePlaceOfACloud) {
  write("a.pcd", ground_from(0, 0));
  std::filesystem::create_symlink(path("a.pcd"), path("b.pcd"));
  const auto bytes = std::filesystem::file_size(path("a.pcd"));
  for (const std::string& output : {path("a.pcd"), path("b.pcd")}) {
    const test::Outcome outcome = test::run_landfix({"map", "--pcd", path("a.pcd"), "--output", output});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.error, HasSubstr("is one of the clouds, which would be lost"));
  }
  EXPECT_EQ(std::filesystem::file_size(path("a.pcd")), bytes);
}

TEST_F(MapCommand, CountsNoCloudTwice) {
  write("a.pcd", ground_from(0, 0));
  std::filesystem::create_symlink(path("a.pcd"), path("b.pcd"));
  for (const std::vector<std::string>& words : {std::vector{path("a.pcd"), path("a.pcd")}, {path("")}}) {
    const test::Outcome outcome = map(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.error, HasSubstr("is given twice"));
  }
}

TEST_F(MapCommand, SaysThatAllPointsLieBeyondTheLattice) {
  write("a.pcd", ground_from(1'000'000'000, 0));
  const test::Outcome outcome = map({path("a.pcd")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("points lie beyond the lattice, which reaches to 4194304 m"));
}

TEST_F(MapCommand, RefusesAnOriginWhereNoCellIs) {
  write("a.pcd", ground_from(0, 0));
  for (const std::string origin : {"1e12,0,0", "0,nan,0"}) {
    const test::Outcome outcome = map({path("a.pcd"), "--origin", origin});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.error, HasSubstr("--origin"));
  }
}

TEST_F(MapCommand, AFullMapIsAnErrorThatSaysWhatToDo) {
  write("a.pcd", ground_from(0, 0));
  const test::Outcome outcome = map({path("a.pcd"), "--capacity", "99"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("the map is full: its points fall in more than 99 cells"));
  EXPECT_EQ(map_of({path("a.pcd"), "--capacity", "100"})["voxels"], 100);
}

}  // namespace
}  // namespace landfix::tools
