// What a map and each sweep cost: building, thinning, matching; PCL beside landfix where it is installed.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "benchmark/benchmark_world.hpp"
#include "ndt/matcher.hpp"
#include "ndt/random_world.hpp"
#include "ndt/voxel_grid.hpp"
#include "tools/pcl_rival.hpp"

namespace landfix {
namespace {

using test::BenchmarkWorld;
using tools::PclRival;

constexpr double kResolution_m = BenchmarkWorld::kResolution_m;

void count_points(benchmark::State& state, std::size_t points) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points));
  state.SetLabel("items are points");
}

void filter_by_landfix(benchmark::State& state, const BenchmarkWorld& world, double leaf_m) {
  ndt::VoxelGrid grid(leaf_m, world.scan_m.size());
  for ([[maybe_unused]] auto _ : state) {
    grid.clear();
    for (const Eigen::Vector3f& point_m : world.scan_m) grid.add(point_m);
    benchmark::DoNotOptimize(grid.finish().data());
  }
  count_points(state, world.scan_m.size());
}

void filter_by_pcl(benchmark::State& state, const BenchmarkWorld& world, double leaf_m) {
  PclRival pcl(kResolution_m, leaf_m);
  pcl.set_scan(world.scan_m);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(pcl.filter());
  count_points(state, world.scan_m.size());
}

void build_by_landfix(benchmark::State& state, const BenchmarkWorld& world) {
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(ndt::test::build_map(world.surveyed_m, kResolution_m));
  count_points(state, world.surveyed_m.size());
}

void build_by_pcl(benchmark::State& state, const BenchmarkWorld& world) {
  PclRival pcl(kResolution_m, 2.0);
  pcl.set_map(world.surveyed_m);
  for ([[maybe_unused]] auto _ : state) pcl.build_map();
  count_points(state, world.surveyed_m.size());
}

void count_iterations(benchmark::State& state, std::size_t points, int iterations) {
  state.counters["points"] = static_cast<double>(points);
  state.counters["steps"] = iterations;
}

void align_by_landfix(benchmark::State& state, const BenchmarkWorld& world, double leaf_m) {
  const std::vector<Eigen::Vector3f> points_m = world.thinned(leaf_m);
  ndt::Matcher matcher({}, points_m.size());
  ndt::MatchResult result;
  for ([[maybe_unused]] auto _ : state) {
    result = matcher.match(world.map, points_m, world.guess);
    benchmark::DoNotOptimize(result);
  }
  count_iterations(state, points_m.size(), result.iterations);
}

void align_by_pcl(benchmark::State& state, const BenchmarkWorld& world, double leaf_m) {
  PclRival pcl(kResolution_m, leaf_m);
  pcl.set_map(world.surveyed_m);
  pcl.build_map();
  pcl.set_scan(world.scan_m);
  const std::size_t points = pcl.filter();
  tools::Found found = pcl.match(world.guess);  // the first one builds a tree that it does not need
  for ([[maybe_unused]] auto _ : state) {
    found = pcl.match(world.guess);
    benchmark::DoNotOptimize(found);
  }
  count_iterations(state, points, found.iterations);
}

[[maybe_unused]] const bool registered = [] {
  const auto add = [](const std::string& name, auto function, auto... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), function, arguments...)->Unit(benchmark::kMicrosecond);
  };
  for (const BenchmarkWorld* const world : test::benchmark_worlds()) {
    const auto at = std::cref(*world);
    const std::string& name = world->name;
    for (const double leaf_m : {2.0, 0.5}) {
      add(fmt::format("filter/landfix/{}/leaf_{}", name, leaf_m), filter_by_landfix, at, leaf_m);
      add(fmt::format("align/landfix/{}/leaf_{}", name, leaf_m), align_by_landfix, at, leaf_m);
      if (!PclRival::available()) continue;
      add(fmt::format("filter/pcl/{}/leaf_{}", name, leaf_m), filter_by_pcl, at, leaf_m);
      add(fmt::format("align/pcl/{}/leaf_{}", name, leaf_m), align_by_pcl, at, leaf_m);
    }
    add("map_build/landfix/" + name, build_by_landfix, at);
    if (PclRival::available()) add("map_build/pcl/" + name, build_by_pcl, at);
  }
  return true;
}();

}  // namespace
}  // namespace landfix
