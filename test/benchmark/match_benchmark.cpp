// What one sweep costs once it is decoded: thinned, then matched to the map.
#include <cstddef>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "ndt/matcher.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_grid.hpp"

namespace landfix::ndt {
namespace {

constexpr std::size_t kSweepPoints = 29'000;  // a VLP-16's at 10 Hz

/// A yard, its map at 1 m, and a sweep seen from the yard's middle.
struct Yard {
  std::vector<Eigen::Vector3d> cloud = test::random_yard(1, kSweepPoints);
  MapImage image = test::build_map(cloud, 1.0);
  VoxelMap map{image.bytes()};
  std::vector<Eigen::Vector3f> sweep = test::seen_from(cloud, Pose::Identity());
};

void thin(VoxelGrid& grid, std::span<const Eigen::Vector3f> sweep) {
  grid.clear();
  for (const Eigen::Vector3f& point_m : sweep) grid.add(point_m);
}

void filter_sweep(benchmark::State& state) {
  const Yard yard;
  VoxelGrid grid(2.0, kSweepPoints);
  for ([[maybe_unused]] auto _ : state) {
    thin(grid, yard.sweep);
    benchmark::DoNotOptimize(grid.finish().data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSweepPoints));
}
BENCHMARK(filter_sweep)->Unit(benchmark::kMicrosecond);

/// The argument is the guess's distance from the truth, in cm.
void match_sweep(benchmark::State& state) {
  const Yard yard;
  VoxelGrid grid(2.0, kSweepPoints);
  thin(grid, yard.sweep);
  const auto points_m = grid.finish();
  const Pose guess(Eigen::Translation3d(0.01 * static_cast<double>(state.range(0)), 0.0, 0.0));
  Matcher matcher({});
  MatchResult result;
  for ([[maybe_unused]] auto _ : state) {
    result = matcher.match(yard.map, points_m, guess);
    benchmark::DoNotOptimize(result);
  }
  state.counters["points"] = static_cast<double>(points_m.size());
  state.counters["iterations"] = result.iterations;
}
BENCHMARK(match_sweep)->Arg(5)->Arg(50)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace landfix::ndt
