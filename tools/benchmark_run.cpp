#include "tools/benchmark_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "ndt/matcher.hpp"
#include "ndt/motion.hpp"
#include "ndt/scan_filter.hpp"
#include "ndt/voxel_map_builder.hpp"
#include "tools/command.hpp"
#include "tools/cpu_clock.hpp"

namespace landfix::tools {
namespace {

/// Of what takes too little time to be timed once, turn and turn about with the rival.
constexpr std::size_t kRounds = 5;

/// Starts around a pose. Draws numbers of its own making: the standard's distributions differ between
/// libraries.
class Perturbation {
 public:
  explicit Perturbation(const BenchmarkSettings& settings) : settings_(settings), random_(settings.seed) {}

  [[nodiscard]] std::vector<ndt::Pose> around(const ndt::Pose& truth) {
    std::vector<ndt::Pose> starts(settings_.starts, truth);
    for (ndt::Pose& start : starts) {
      start.translation() += amount(settings_.perturb_m) * direction();
      start.linear() = truth.linear() * ndt::rotation_exp(amount(settings_.perturb_rad) * direction());
    }
    return starts;
  }

 private:
  [[nodiscard]] double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  [[nodiscard]] double amount(double most) { return settings_.perturb_exactly ? most : most * unit(); }
  /// Uniform on the sphere: z and the angle around it are uniform (Archimedes).
  [[nodiscard]] Eigen::Vector3d direction() {
    const double z = 2.0 * unit() - 1.0;
    const double angle = 360.0 * kRadians_per_deg * unit();
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

  const BenchmarkSettings& settings_;
  std::mt19937_64 random_;
};

/// landfix, in the same steps as its rival.
class Landfix {
 public:
  Landfix(const ndt::VoxelMap& map, const ndt::FilterSettings& filter)
      : map_(map), leaf_m_(filter.leaf_m), filter_(filter, kCapacity), matcher_({}, kCapacity) {}

  void set_scan(std::span<const Eigen::Vector3f> points_m) {
    scan_m_ = points_m;
    rings_ = elevation_steps(points_m);
  }

  std::size_t filter() {
    filter_.clear();
    filter_.add(scan_m_, rings_);
    filtered_m_ = filter_.finish();
    return filtered_m_.size();
  }

  [[nodiscard]] Found match(const ndt::Pose& guess) {
    const ndt::MatchResult match = matcher_.match(map_, filtered_m_, guess);
    return {.pose = match.pose, .iterations = match.iterations};
  }

  /// Throws std::runtime_error where the filter had no room for all of the scan.
  void check(const std::string& scan) const {
    if (filter_.dropped_points() == 0) return;
    throw std::runtime_error(
        fmt::format("{}: more than {} cells of {} m; choose a larger --leaf", scan, kCapacity, leaf_m_));
  }

 private:
  static constexpr std::size_t kCapacity = 1 << 16;

  const ndt::VoxelMap& map_;
  double leaf_m_;
  ndt::ScanFilter filter_;
  ndt::Matcher matcher_;
  std::span<const Eigen::Vector3f> scan_m_;
  std::vector<std::uint16_t> rings_;
  std::span<const Eigen::Vector3f> filtered_m_;
};

template <class Contestant>
void time_filter(Contestant& contestant, Performance& performance) {
  std::size_t points = 0;
  performance.filter_cpu_ms.push_back(cpu_ms_of([&] { points = contestant.filter(); }));
  // The mean so far, moved towards the new one.
  performance.points_mean += (static_cast<double>(points) - performance.points_mean) /
                             static_cast<double>(performance.filter_cpu_ms.size());
}

/// Returns the last pose found.
template <class Contestant>
ndt::Pose time_matches(Contestant& contestant, std::span<const ndt::Pose> starts, const ndt::Pose& truth,
                       Performance& performance) {
  Found found;
  for (const ndt::Pose& start : starts) {
    performance.match_cpu_ms.push_back(cpu_ms_of([&] { found = contestant.match(start); }));
    performance.samples.push_back(compare(found.pose, truth, found.iterations));
  }
  return found.pose;
}

/// Caches, page faults and what is built at first use are nobody's time.
template <class Contestant>
void warm_up(Contestant& contestant, const ndt::Pose& truth) {
  static_cast<void>(contestant.filter());
  static_cast<void>(contestant.match(truth));
}

/// Where the two poses before lead to; the truth for the first scan.
[[nodiscard]] ndt::Pose next_guess(std::span<const ndt::StampedPose> track, const ndt::StampedPose& truth) {
  if (track.empty()) return truth.pose;
  if (track.size() == 1) return track[0].pose;
  const ndt::StampedPose& last = track.back();
  return ndt::predict(last, ndt::velocity_between(track[track.size() - 2], last), truth.stamp_utc_ns);
}

[[nodiscard]] ndt::MapImage build_map(std::span<const Eigen::Vector3d> points_m, double resolution_m) {
  ndt::VoxelMapBuilder builder(resolution_m, std::clamp(points_m.size(), std::size_t{1}, kMapCapacity));
  for (const Eigen::Vector3d& point_m : points_m) builder.add(point_m);
  return builder.build();
}

}  // namespace

ndt::MapImage build_timed(std::span<const Eigen::Vector3d> points_m, double resolution_m, PclRival* rival,
                          BenchmarkResult& result) {
  const std::size_t rounds = rival == nullptr ? 1 : kRounds;
  if (rival != nullptr) rival->set_map(points_m);
  ndt::MapImage map;
  for (std::size_t round = 0; round < rounds; ++round) {
    const double ours_ms = cpu_ms_of([&] { map = build_map(points_m, resolution_m); });
    result.ours.build_cpu_ms.push_back(ours_ms);
    if (rival == nullptr) continue;
    const double rival_ms = cpu_ms_of([&] { rival->build_map(); });
    result.rival.build_cpu_ms.push_back(rival_ms);
    result.ratios.build.push_back(rival_ms / ours_ms);
  }
  return map;
}

void run_benchmark(const ndt::VoxelMap& map, std::span<const std::filesystem::path> scans,
                   std::span<const ndt::StampedPose> truth, const BenchmarkSettings& settings,
                   PclRival* rival, BenchmarkResult& result) {
  Landfix landfix(map, settings.filter);
  Perturbation perturbation(settings);
  std::vector<ndt::StampedPose> track;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    show_progress(fmt::format("scan {} of {}", i + 1, scans.size()));
    const auto scan = load_scan(scans[i], settings.limits);
    landfix.set_scan(scan);
    if (rival != nullptr) rival->set_scan(scan);
    if (i == 0) {
      warm_up(landfix, truth[i].pose);
      if (rival != nullptr) warm_up(*rival, truth[i].pose);
    }

    for (std::size_t round = 0; round < (rival == nullptr ? 1 : kRounds); ++round) {
      time_filter(landfix, result.ours);
      if (rival == nullptr) continue;
      time_filter(*rival, result.rival);
      result.ratios.filter.push_back(result.rival.filter_cpu_ms.back() / result.ours.filter_cpu_ms.back());
    }
    landfix.check(scans[i].string());

    std::vector<ndt::Pose> starts{next_guess(track, truth[i])};
    if (!settings.in_sequence) starts = perturbation.around(truth[i].pose);
    const ndt::Pose last = time_matches(landfix, starts, truth[i].pose, result.ours);
    if (settings.in_sequence) track.push_back({truth[i].stamp_utc_ns, last});
    if (rival != nullptr) {
      const auto shared = std::span(starts).first(std::min(settings.rival_starts, starts.size()));
      static_cast<void>(time_matches(*rival, shared, truth[i].pose, result.rival));
      for (std::size_t start = 0; start < shared.size(); ++start) {
        const auto ms_of = [start](const Performance& performance, std::size_t starts_of_scan) {
          return performance.match_cpu_ms[performance.match_cpu_ms.size() - starts_of_scan + start];
        };
        result.ratios.match.push_back(ms_of(result.rival, shared.size()) / ms_of(result.ours, starts.size()));
      }
    }
  }
  show_progress("");
  result.scans = scans.size();
}

}  // namespace landfix::tools
