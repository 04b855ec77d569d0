#include "tools/quality_run.hpp"

#include <algorithm>
#include <atomic>
#include <random>
#include <thread>

namespace landfix::tools {
namespace {

/// Points that a thread takes at a time, and that are summed first: so the sum is that of one thread.
constexpr std::size_t kPortion = 1024;

/// One of each of so many stretches of the cloud, which are as long as each other.
[[nodiscard]] std::vector<std::uint32_t> choose(std::size_t points, const QualitySettings& settings) {
  const std::size_t count = settings.sample == 0 ? points : std::min(settings.sample, points);
  std::vector<std::uint32_t> chosen(count);
  std::mt19937_64 random(settings.seed);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * points / count;
    const std::size_t length = (i + 1) * points / count - first;
    chosen[i] = static_cast<std::uint32_t>(first + random() % length);
  }
  return chosen;
}

}  // namespace

QualityResult judge_map(const ndt::NeighbourTree& tree, const QualitySettings& settings,
                        const std::function<void(double)>& progress) {
  const std::vector<std::uint32_t> chosen = choose(tree.points_m().size(), settings);
  std::vector<ndt::MapQuality> portions((chosen.size() + kPortion - 1) / kPortion);
  QualityResult result;
  if (settings.keep_points) result.points.resize(chosen.size());
  std::atomic<std::size_t> next = 0;
  const auto judge_portions = [&](bool shows_progress) {
    ndt::QualityProbe probe(tree, settings.radius_m);
    const auto take_portion = [&next] { return next.fetch_add(1, std::memory_order_relaxed); };
    for (std::size_t portion = take_portion(); portion < portions.size(); portion = take_portion()) {
      const std::size_t end = std::min(chosen.size(), (portion + 1) * kPortion);
      for (std::size_t i = portion * kPortion; i < end; ++i) {
        const auto point = probe.at(chosen[i]);
        portions[portion].add(point);
        if (!settings.keep_points) continue;
        const Eigen::Vector3f& position_m = tree.points_m()[chosen[i]];
        JudgedPoint& judged = result.points[i];
        judged = {.x = position_m.x(), .y = position_m.y(), .z = position_m.z()};
        if (!point) continue;
        judged.entropy = static_cast<float>(point->entropy);
        judged.plane_variance_m = static_cast<float>(point->plane_variance_m);
      }
      if (shows_progress) progress(static_cast<double>(portion) / static_cast<double>(portions.size()));
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back([&judge_portions] { judge_portions(false); });
    judge_portions(true);
  }
  for (const ndt::MapQuality& portion : portions) result.quality += portion;
  return result;
}

}  // namespace landfix::tools
