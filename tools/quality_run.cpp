#include "tools/quality_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>
#include <unordered_set>

#include "tools/input_files.hpp"

namespace landfix::tools {
namespace {

/// Points that a thread takes at a time, and that are summed first: so the sum is that of one thread.
constexpr std::size_t kPortion = 1024;

/// One of each of so many stretches of the cloud, which are as long as each other.
[[nodiscard]] std::vector<std::uint64_t> choose(std::uint64_t points, const QualitySettings& settings) {
  const std::uint64_t count = std::min<std::uint64_t>(settings.sample, points);
  std::vector<std::uint64_t> chosen(count);
  std::mt19937_64 random(settings.seed);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t first = i * points / count;
    const std::uint64_t length = (i + 1) * points / count - first;
    chosen[i] = first + random() % length;
  }
  return chosen;
}

/// Where the neighbours of some points can be: cells as wide as their radius, each with those around it.
class Surroundings {
 public:
  explicit Surroundings(double radius_m) : inverse_radius_1pm_(1.0 / radius_m) {}

  void add(const Eigen::Vector3d& point_m) {
    const Place place = place_of(point_m);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) cells_.insert(key_of(place + Place(i, j, k)));
  }
  [[nodiscard]] bool hold(const Eigen::Vector3d& point_m) const {
    return cells_.contains(key_of(place_of(point_m)));
  }

 private:
  using Place = Eigen::Matrix<std::int64_t, 3, 1>;

  [[nodiscard]] Place place_of(const Eigen::Vector3d& point_m) const {
    // As exact as the tree keeps the points.
    const Eigen::Vector3d kept_m = point_m.cast<float>().cast<double>();
    return (inverse_radius_1pm_ * kept_m).array().floor().cast<std::int64_t>();
  }
  /// Cells that are 2^21 apart share one, which does no harm: some points too many are kept.
  [[nodiscard]] static std::uint64_t key_of(const Place& place) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(place.x()) & kMask) << 42 |
           (static_cast<std::uint64_t>(place.y()) & kMask) << 21 |
           (static_cast<std::uint64_t>(place.z()) & kMask);
  }

  double inverse_radius_1pm_;
  std::unordered_set<std::uint64_t> cells_;
};

[[nodiscard]] QualityCloud load_all(const std::vector<std::filesystem::path>& clouds) {
  QualityCloud cloud;
  visit_clouds(clouds,
               [&](const Eigen::Vector3d& point_m) { cloud.points_m.emplace_back(point_m.cast<float>()); });
  cloud.chosen.resize(cloud.points_m.size());
  std::iota(cloud.chosen.begin(), cloud.chosen.end(), 0U);
  cloud.cloud_points = cloud.points_m.size();
  return cloud;
}

/// Reads the clouds three times: how many points there are, which are chosen, what is around those.
[[nodiscard]] QualityCloud load_sample(const std::vector<std::filesystem::path>& clouds,
                                       const QualitySettings& settings) {
  std::uint64_t points = 0;
  visit_clouds(clouds, [&](const Eigen::Vector3d& /*point_m*/) { ++points; });
  const std::vector<std::uint64_t> chosen = choose(points, settings);
  const auto visit = [&](const auto& take) {
    std::uint64_t number = 0;
    auto next = chosen.begin();
    visit_clouds(clouds, [&](const Eigen::Vector3d& point_m) {
      const bool is_chosen = next != chosen.end() && *next == number;
      if (is_chosen) ++next;
      ++number;
      take(point_m, is_chosen);
    });
  };
  Surroundings surroundings(settings.radius_m);
  visit([&](const Eigen::Vector3d& point_m, bool is_chosen) {
    if (is_chosen) surroundings.add(point_m);
  });
  QualityCloud cloud;
  cloud.cloud_points = points;
  visit([&](const Eigen::Vector3d& point_m, bool is_chosen) {
    if (is_chosen) cloud.chosen.push_back(static_cast<std::uint32_t>(cloud.points_m.size()));
    if (surroundings.hold(point_m)) cloud.points_m.emplace_back(point_m.cast<float>());
  });
  return cloud;
}

}  // namespace

QualityCloud load_quality_cloud(const std::vector<std::filesystem::path>& clouds,
                                const QualitySettings& settings) {
  return settings.sample == 0 ? load_all(clouds) : load_sample(clouds, settings);
}

QualityResult judge_map(const ndt::NeighbourTree& tree, std::span<const std::uint32_t> chosen,
                        const QualitySettings& settings, const std::function<void(double)>& progress) {
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
