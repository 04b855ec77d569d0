#include "ndt/voxel_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ndt/crc32c.hpp"
#include "ndt/map_file.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "ndt/voxel_moments.hpp"

namespace landfix::ndt::test {
namespace {

using ::testing::HasSubstr;

[[nodiscard]] std::string error_of(std::span<const std::byte> bytes) {
  try {
    (void)load_map(bytes, "street.ndt");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

[[nodiscard]] Eigen::Matrix3d matrix(const Symmetric3f& s) {
  Eigen::Matrix3f m;
  m << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return m.cast<double>();
}

TEST(Lattice, BlockKeysKeepTheirCorner) {
  for (const std::int32_t i : {-kMaxCell, -5, -4, -1, 0, 3, 4, kMaxCell - 1}) {
    for (const std::int32_t j : {-9, 0, 8}) {
      const Cell cell{i, j, -i / 2};
      const Cell corner = block_corner(block_key(cell));
      EXPECT_EQ(corner, (Cell{cell.i & ~3, cell.j & ~3, cell.k & ~3})) << i << ' ' << j;
    }
  }
}

/// The inverse of a covariance whose variances along its axes are changed first.
Eigen::Matrix3d inverse_with(const Eigen::Matrix3d& covariance_m2,
                             const std::function<double(double variance_m2, double largest_m2)>& changed) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_m2);
  Eigen::Vector3d inverse;
  for (int i = 0; i < 3; ++i) inverse[i] = 1.0 / changed(eigen.eigenvalues()[i], eigen.eigenvalues()[2]);
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

/// A variance divided by 0.3, but not beyond (0.2 m)^2 unless it is beyond that by itself; at least (5 mm)^2.
/// Blurred by 0.15 m over n - 1 first, at a resolution of 1 m.
double sharp_variance_m2(double variance_m2, double n) {
  const double blur_m = 0.15 / (n - 1.0);
  const double bounded_m2 = std::max(variance_m2, 25e-6) + blur_m * blur_m;
  return std::min(bounded_m2 / 0.3, std::max(bounded_m2, 0.04));
}

/// At least a hundredth of the largest.
double wide_variance_m2(double variance_m2, double largest_m2) {
  return std::max(variance_m2, 0.01 * largest_m2);
}

TEST(VoxelMapBuilder, AVoxelHasTheMomentsOfItsPoints) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  // One voxel's worth of points, far from the origin, with a shape of its own.
  const Eigen::Vector3d place_m(123456.5, -98765.5, 10.5);
  Eigen::Matrix3d shape;
  shape << 0.1, 0.02, 0.0, 0.0, 0.07, 0.03, 0.0, 0.0, 0.05;
  std::vector<Eigen::Vector3d> points;
  while (points.size() < 200) {
    const Eigen::Vector3d p = shape * Eigen::Vector3d(normal(random), normal(random), normal(random));
    if (p.cwiseAbs().maxCoeff() < 0.45) points.emplace_back(place_m + p);
  }
  const MapImage image = build_map(points, 1.0);
  const VoxelMap map(image.bytes());
  ASSERT_EQ(map.voxels().size(), 1U);
  const Voxel& voxel = map.voxels().front();

  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p / 200.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : points) covariance += (p - mean) * (p - mean).transpose() / 199.0;
  EXPECT_EQ(voxel.count, 200U);
  const Eigen::Vector3d corner(123456.0, -98766.0, 10.0);
  EXPECT_LT((corner + Eigen::Map<const Eigen::Vector3f>(voxel.mean_m.data()).cast<double>() - mean).norm(),
            1e-6);
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d sharp =
      inverse_with(covariance, [](double v, double) { return sharp_variance_m2(v, 200.0); });
  EXPECT_LT((matrix(voxel.sharp_1pm2) - sharp).norm(), 1e-4 * sharp.norm());
  EXPECT_LT((matrix(voxel.wide_1pm2) * (covariance + identity / 199.0) - identity).norm(), 1e-4);
}

TEST(VoxelMapBuilder, AFlatVoxelIsAsThickAsASurveyIsGoodWhereItIsSharp) {
  std::vector<Eigen::Vector3d> plane;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) plane.emplace_back(0.05 + 0.1 * i, 0.05 + 0.1 * j, 0.5);
  }
  const MapImage image = build_map(plane, 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> sharp(
      matrix(VoxelMap(image.bytes()).voxels()[0].sharp_1pm2));
  EXPECT_NEAR(1.0 / sharp.eigenvalues()[2], sharp_variance_m2(0.0, 100.0), 1e-8);
  EXPECT_NEAR(1.0 / sharp.eigenvalues()[0], sharp_variance_m2(0.0825 * 100.0 / 99.0, 100.0), 1e-6);
}

/// Voxels by the cell they are in, from a corner of the map.
using VoxelsByCell = std::map<std::array<long, 3>, std::array<float, 15>>;

[[nodiscard]] VoxelsByCell voxels_by_cell(const VoxelMap& map, const Eigen::Vector3d& corner_m) {
  VoxelsByCell voxels;
  visit_voxels(map, [&](const Voxel& voxel, const Eigen::Vector3d& mean_m) {
    const Eigen::Vector3d cell = ((mean_m - corner_m) / map.resolution_m()).array().floor();
    auto& values = voxels[{std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())}];
    std::copy(voxel.mean_m.begin(), voxel.mean_m.end(), values.begin());
    std::copy(voxel.wide_1pm2.begin(), voxel.wide_1pm2.end(), values.begin() + 3);
    std::copy(voxel.sharp_1pm2.begin(), voxel.sharp_1pm2.end(), values.begin() + 9);
  });
  return voxels;
}

TEST(VoxelMapBuilder, AMillionMetresAwayTheVoxelsAreTheSameToTheBit) {
  std::vector<Eigen::Vector3d> here = random_yard(5, 20000);
  // Coordinates that a double holds at both places.
  for (Eigen::Vector3d& point_m : here) point_m = (point_m * 0x1p20).array().round() * 0x1p-20;
  const Eigen::Vector3d far_m(1'000'000.0, -999'997.0, 31.0);
  std::vector<Eigen::Vector3d> there = here;
  for (Eigen::Vector3d& point_m : there) point_m += far_m;
  const MapImage near = build_map(here, 1.0);
  const MapImage far = load_map(build_map(there, 1.0).bytes(), "far.ndt");
  const auto expected = voxels_by_cell(VoxelMap(near.bytes()), Eigen::Vector3d::Zero());
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(voxels_by_cell(VoxelMap(far.bytes()), far_m), expected);
}

TEST(VoxelMoments, TheClosedFormOfItsAxesIsAsGoodAsTheIteration) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-3.0, -0.5);
  for (int run = 0; run < 2000; ++run) {
    const Eigen::Matrix3d axes = random_pose(random, 0.0, 3.0).linear();
    Eigen::Vector3d sigma_m(std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)),
                            std::pow(10.0, exponent(random)));
    if (run % 3 == 0) sigma_m.y() = sigma_m.x();
    if (run % 7 == 0) sigma_m.z() = 0.0;
    VoxelMoments moments;
    Eigen::Matrix3Xd points(3, 40);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      points.col(i) =
          axes * sigma_m.cwiseProduct(Eigen::Vector3d(normal(random), normal(random), normal(random)));
      moments.add(points(0, i), points(1, i), points(2, i));
    }
    ASSERT_TRUE(has_shape(moments));
    const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
    const Eigen::Matrix3d covariance = centred * centred.transpose() / 39.0;
    const Voxel voxel = to_voxel(moments, 1.0);
    const Eigen::Matrix3d sharp =
        inverse_with(covariance, [](double v, double) { return sharp_variance_m2(v, 40.0); });
    const Eigen::Matrix3d wide =
        inverse_with(covariance + Eigen::Matrix3d::Identity() / 39.0, wide_variance_m2);
    EXPECT_LT((matrix(voxel.sharp_1pm2) - sharp).norm(), 1e-6 * sharp.norm()) << run;
    EXPECT_LT((matrix(voxel.wide_1pm2) - wide).norm(), 1e-6 * wide.norm()) << run;
  }
}

TEST(VoxelMapBuilder, TheOrderOfThePointsHardlyMatters) {
  std::vector<Eigen::Vector3d> points = random_yard(4, 20000);
  const auto forward = voxels_by_cell(VoxelMap(build_map(points, 1.0).bytes()), Eigen::Vector3d::Zero());
  std::shuffle(points.begin(), points.end(), std::mt19937_64(7));
  const auto shuffled = voxels_by_cell(VoxelMap(build_map(points, 1.0).bytes()), Eigen::Vector3d::Zero());
  ASSERT_EQ(shuffled.size(), forward.size());
  for (const auto& [cell, values] : forward) {
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(shuffled.at(cell)[i], values[i], 1e-4F * (1.0F + std::abs(values[i])));
  }
}

TEST(VoxelMapBuilder, LeavesOutCellsWithTooFewPointsOrNoExtent) {
  VoxelMapBuilder builder(1.0, 10);
  for (std::uint32_t i = 0; i + 1 < kMinVoxelPoints; ++i) builder.add({0.1 * i, 0.5, 0.5});
  for (int i = 0; i < 50; ++i) builder.add({7.5, 7.5, 7.5});
  EXPECT_THROW((void)builder.build(), std::runtime_error);
  for (int i = 0; i < 6; ++i) builder.add({3.1 + 0.1 * i, 0.5, 0.5});
  const MapImage image = builder.build();
  EXPECT_EQ(VoxelMap(image.bytes()).voxels().size(), 1U);
}

TEST(VoxelMapBuilder, AFullMapSaysSo) {
  VoxelMapBuilder builder(1.0, 2);
  builder.add({0.5, 0.5, 0.5});
  builder.add({1.5, 0.5, 0.5});
  builder.add({0.6, 0.5, 0.5});
  try {
    builder.add({2.5, 0.5, 0.5});
    FAIL() << "a third cell was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the map is full"));
  }
}

TEST(VoxelMapBuilder, ForgetsWhatIsFarAwayAsIfItHadNeverCome) {
  constexpr double kWithin_m = 9.0;
  const Eigen::Vector3d place_m(3.0, -2.0, 100.0);  // the height does not count
  const auto is_near = [&](const Eigen::Vector3d& point_m) {
    const Eigen::Array2d middle_m = 4.0 * (point_m.head<2>().array() / 4.0).floor() + 2.0;  // of its block
    return (middle_m.matrix() - place_m.head<2>()).norm() <= kWithin_m;
  };
  VoxelMapBuilder builder(1.0, 100'000);
  VoxelMapBuilder only_near(1.0, 100'000);
  for (const Eigen::Vector3d& point_m : random_yard(1, 20'000)) {
    builder.add(point_m);
    if (is_near(point_m)) only_near.add(point_m);
  }
  ASSERT_LT(only_near.points(), builder.points());
  builder.forget_beyond(place_m, kWithin_m);
  EXPECT_EQ(builder.points(), only_near.points());
  EXPECT_EQ(builder.cells(), only_near.cells());
  const MapImage image = builder.build();
  const MapImage expected = only_near.build();
  EXPECT_TRUE(std::ranges::equal(image.bytes(), expected.bytes()));
}

TEST(VoxelMapBuilder, SkipsPointsThatHaveNoPlaceInTheLattice) {
  VoxelMapBuilder builder(1.0, 2);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e9, -1e300}) builder.add({0.0, bad, 0.0});
  EXPECT_EQ(builder.skipped_points(), 5U);
  EXPECT_EQ(builder.points(), 0U);
}

TEST(VoxelMapBuilder, RefusesSizesThatAreNone) {
  EXPECT_THROW(VoxelMapBuilder(0.0, 10), std::runtime_error);
  EXPECT_THROW(VoxelMapBuilder(-1.0, 10), std::runtime_error);
  EXPECT_THROW(VoxelMapBuilder(1e-300, 10), std::runtime_error);
  EXPECT_THROW(VoxelMapBuilder(1e300, 10), std::runtime_error);
  EXPECT_THROW(VoxelMapBuilder(std::numeric_limits<double>::quiet_NaN(), 10), std::runtime_error);
  EXPECT_THROW(VoxelMapBuilder(1.0, 0), std::runtime_error);
}

TEST(MapFile, IsReadBackToTheByte) {
  const MapImage image = build_map(random_yard(1, 20000), 1.0);
  const MapImage loaded = load_map(image.bytes(), "street.ndt");
  EXPECT_TRUE(std::ranges::equal(image.bytes(), loaded.bytes()));
}

TEST(Crc32c, HasItsCheckValueHoweverTheBytesAreSplit) {
  const std::string digits = "123456789";
  for (std::size_t split = 0; split <= digits.size(); ++split) {
    const auto bytes = std::as_bytes(std::span(digits));
    const std::uint32_t first = crc32c_update(kCrc32cStart, bytes.first(split));
    EXPECT_EQ(~crc32c_update(first, bytes.subspan(split)), 0xE3069283U);
  }
}

TEST(Crc32c, TheProcessorsInstructionAgreesWithTheTable) {
  std::mt19937_64 random(1);
  std::vector<std::byte> bytes(1000);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    const auto some = std::span(bytes).subspan(size % 13, size / 2);
    EXPECT_EQ(crc32c_update(kCrc32cStart, some), crc32c_update_by_table(kCrc32cStart, some)) << size;
  }
}

TEST(MapFile, ItsTilesAreRunsThatCoverItInOrder) {
  const MapImage image = build_map(random_yard(1, 20000), 0.25);
  const VoxelMap map(image.bytes());
  const MapHeader& header = map.header();
  EXPECT_GT(header.tile_count, 4U);
  // Each block of the directory is found in the table, with the voxels that the tile says it has.
  const MapLayout layout(header);
  const auto* const blocks = reinterpret_cast<const TileBlock*>(image.bytes().data() + layout.blocks);
  std::uint32_t voxel = 0;
  for (const TileBlock& block : std::span(blocks, header.block_count)) {
    const BlockEntry* const entry = map.find_block(block.key);
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->occupancy, block.occupancy);
    EXPECT_EQ(entry->first_voxel, voxel);
    voxel += static_cast<std::uint32_t>(std::popcount(block.occupancy));
  }
  EXPECT_EQ(voxel, map.voxels().size());
}

TEST(MapFile, ADirectoryThatLiesIsRefusedThoughItsChecksumsAgree) {
  const MapImage image = build_map(random_yard(1, 20000), 0.25);
  const MapLayout layout(VoxelMap(image.bytes()).header());
  const auto refused_with = [&image](std::uint64_t offset, std::byte change) {
    std::vector<std::byte> bytes(image.bytes().begin(), image.bytes().end());
    bytes[offset] ^= change;
    seal_map(bytes);
    return error_of(bytes);
  };
  EXPECT_THAT(refused_with(layout.tiles + offsetof(TileEntry, key), std::byte{1}), HasSubstr("directory"));
  EXPECT_THAT(refused_with(layout.tiles + offsetof(TileEntry, first_block), std::byte{1}),
              HasSubstr("directory"));
  EXPECT_THAT(refused_with(layout.tiles + offsetof(TileEntry, blocks) + 3, std::byte{0x80}),
              HasSubstr("directory"));
  EXPECT_THAT(refused_with(layout.blocks + offsetof(TileBlock, occupancy), std::byte{1}),
              HasSubstr("directory"));
  EXPECT_THAT(refused_with(layout.blocks + offsetof(TileBlock, key) + 4, std::byte{1}),
              HasSubstr("directory"));
}

TEST(VoxelMap, WithoutAnImageItHasNoVoxel) {
  const VoxelMap map;
  EXPECT_TRUE(map.voxels().empty());
  for (std::uint64_t key = 0; key < 100; ++key) EXPECT_EQ(map.find_block(key), nullptr);
  visit_voxels(map, [](const Voxel& /*voxel*/, const Eigen::Vector3d& /*mean_m*/) { FAIL(); });
}

TEST(MapFile, RefusesEveryTruncationAndEveryFlippedByte) {
  const MapImage image = build_map(random_yard(1, 3000), 4.0);
  std::vector<std::byte> bytes(image.bytes().begin(), image.bytes().end());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(error_of(std::span(bytes).first(size)), "no error") << size;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] ^= std::byte{0x10};
    EXPECT_NE(error_of(bytes), "no error") << i;
    bytes[i] ^= std::byte{0x10};
  }
  EXPECT_EQ(error_of(bytes), "no error");
}

TEST(MapFile, SaysWhatIsWrong) {
  const MapImage image = build_map(random_yard(1, 3000), 4.0);
  std::vector<std::byte> bytes(image.bytes().begin(), image.bytes().end());
  EXPECT_THAT(
      error_of(std::as_bytes(std::span("# .PCD v0.7 - Point Cloud Data file format, and so on for a while"))),
      HasSubstr("street.ndt: not a landfix map"));
  EXPECT_THAT(error_of(std::span(bytes).first(bytes.size() - 64)), HasSubstr("truncated"));
  std::vector<std::byte> newer = bytes;
  newer[offsetof(MapHeader, version)] = std::byte{9};
  EXPECT_THAT(error_of(newer), HasSubstr("map version 9"));
  std::vector<std::byte> damaged = bytes;
  std::vector<std::byte> damaged_voxel = bytes;
  damaged_voxel[MapLayout(VoxelMap(image.bytes()).header()).voxels + 5] ^= std::byte{1};
  EXPECT_THAT(error_of(damaged_voxel), ::testing::ContainsRegex("its tile from .* m on is damaged"));
  std::vector<std::byte> longer = bytes;
  longer.resize(bytes.size() + 3);
  EXPECT_THAT(error_of(longer), HasSubstr("3 more than"));
  damaged.back() ^= std::byte{1};
  EXPECT_THAT(error_of(damaged), HasSubstr("directory of tiles is damaged"));
}

TEST(MapFile, RefusesAResolutionThatNoCellCanHave) {
  const MapImage image = build_map(random_yard(1, 3000), 4.0);
  std::vector<std::byte> bytes(image.bytes().begin(), image.bytes().end());
  for (const double resolution_m : {1e300, 1e-300, -4.0, std::numeric_limits<double>::quiet_NaN()}) {
    MapHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    header.resolution_m = resolution_m;
    std::memcpy(bytes.data(), &header, sizeof header);
    seal_map(bytes);
    EXPECT_THAT(error_of(bytes), HasSubstr("its header makes no sense")) << resolution_m;
  }
}

}  // namespace
}  // namespace landfix::ndt::test
