// Where the time of a match goes: finding the voxels near each point, and summing up over the pairs.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <benchmark/benchmark.h>

#include "benchmark/benchmark_world.hpp"
#include "ndt/pair_groups.hpp"
#include "ndt/pair_kernel.hpp"
#include "ndt/score.hpp"

namespace landfix::ndt {
namespace {

using test::BenchmarkWorld;

constexpr double kLeaf_m = 2.0;

void look_up(const BenchmarkWorld& world, std::span<const Eigen::Vector3f> points_m, PairGroups& groups) {
  groups.assign(points_m);
  for (std::size_t i = 0; i < groups.groups().size(); ++i) {
    groups.update(world.map, world.truth, Covariance::wide, i);
  }
}

/// The sums over the group that has most pairs.
void kernel(benchmark::State& state, const BenchmarkWorld& world) {
  const std::vector<Eigen::Vector3f> points_m = world.thinned(kLeaf_m);
  PairGroups groups(points_m.size());
  look_up(world, points_m, groups);
  const auto all = groups.groups();
  const auto fullest = std::max_element(all.begin(), all.end(), [](const PairGroup& a, const PairGroup& b) {
    return a.pair_count < b.pair_count;
  });
  GroupPlace place{.radius_m2 = static_cast<float>(BenchmarkWorld::kResolution_m)};
  const Eigen::Matrix3f rotation = world.truth.linear().cast<float>();
  for (int i = 0; i < 9; ++i) place.rotation[static_cast<std::size_t>(i)] = rotation(i / 3, i % 3);
  const Cell origin = fullest->origin;
  const Eigen::Vector3f centre_m =
      (world.truth * fullest->centre_m -
       BenchmarkWorld::kResolution_m * Eigen::Vector3d(origin.i, origin.j, origin.k))
          .cast<float>();
  place.centre_m = {centre_m.x(), centre_m.y(), centre_m.z()};
  const PairColumns& columns = groups.columns(static_cast<std::size_t>(fullest - all.begin()));
  const ScoreConstants constants = score_constants(0.55, BenchmarkWorld::kResolution_m);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(sum_pairs(columns, fullest->pair_count, place, constants));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(fullest->pair_count));
  state.SetLabel("items are pairs");
}

/// All points of a scan anew, with the covariances of what they find.
void lookup(benchmark::State& state, const BenchmarkWorld& world) {
  const std::vector<Eigen::Vector3f> points_m = world.thinned(kLeaf_m);
  PairGroups groups(points_m.size());
  for ([[maybe_unused]] auto _ : state) {
    look_up(world, points_m, groups);
    benchmark::DoNotOptimize(groups.groups().data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points_m.size()));
  state.SetLabel("items are points");
}

[[maybe_unused]] const bool registered = [] {
  for (const BenchmarkWorld* const world : test::benchmark_worlds()) {
    benchmark::RegisterBenchmark(("kernel/" + world->name).c_str(), kernel, std::cref(*world));
    benchmark::RegisterBenchmark(("lookup/" + world->name).c_str(), lookup, std::cref(*world))
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace landfix::ndt
