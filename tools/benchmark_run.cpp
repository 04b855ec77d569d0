#include "tools/benchmark_run.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "ndt/motion.hpp"
#include "ndt/scan_filter.hpp"
#include "tools/command.hpp"

namespace landfix::tools {
namespace {

constexpr double kOk_m = 0.1;
constexpr double kOk_rad = 0.5 * kRadians_per_deg;

[[nodiscard]] double thread_cpu_ms() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

/// Starts around a pose. Draws numbers of its own making: the standard's distributions differ between
/// libraries.
class Perturbation {
 public:
  explicit Perturbation(const BenchmarkSettings& settings) : settings_(settings), random_(settings.seed) {}

  [[nodiscard]] ndt::Pose around(const ndt::Pose& truth) {
    ndt::Pose start = truth;
    start.translation() += amount(settings_.perturb_m) * direction();
    start.linear() = truth.linear() * ndt::rotation_exp(amount(settings_.perturb_rad) * direction());
    return start;
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

[[nodiscard]] BenchmarkSample compare(const ndt::MatchResult& result, const ndt::Pose& truth,
                                      double match_cpu_ms) {
  return {.error_m = (result.pose.translation() - truth.translation()).norm(),
          .error_rad = ndt::angle_between(result.pose, truth),
          .iterations = result.iterations,
          .match_cpu_ms = match_cpu_ms};
}

/// Where the two poses before lead to; the truth for the first scan.
[[nodiscard]] ndt::Pose next_guess(std::span<const ndt::StampedPose> track, const ndt::StampedPose& truth) {
  if (track.empty()) return truth.pose;
  if (track.size() == 1) return track[0].pose;
  const ndt::StampedPose& last = track.back();
  return ndt::predict(last, ndt::velocity_between(track[track.size() - 2], last), truth.stamp_utc_ns);
}

}  // namespace

bool BenchmarkSample::ok() const noexcept { return error_m <= kOk_m && error_rad <= kOk_rad; }

BenchmarkResult run_benchmark(const ndt::VoxelMap& map, std::span<const std::filesystem::path> scans,
                              std::span<const ndt::StampedPose> truth, const BenchmarkSettings& settings) {
  constexpr std::size_t kGridCapacity = 1 << 18;
  BenchmarkResult result;
  ndt::ScanFilter filter(settings.filter, kGridCapacity);
  ndt::Matcher matcher({}, kGridCapacity);
  Perturbation perturbation(settings);
  std::vector<ndt::StampedPose> track;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    show_progress(fmt::format("scan {} of {}", i + 1, scans.size()));
    const auto scan = load_scan(scans[i], settings.limits);
    const auto rings = elevation_steps(scan);
    const double filter_began_ms = thread_cpu_ms();
    filter.clear();
    for (std::size_t n = 0; n < scan.size(); ++n) filter.add(scan[n], rings[n]);
    const auto points_m = filter.finish();
    result.filter_cpu_ms.push_back(thread_cpu_ms() - filter_began_ms);
    if (filter.dropped_points() != 0) {
      throw std::runtime_error(fmt::format("{}: more than {} cells of {} m; choose a larger --leaf",
                                           scans[i].string(), kGridCapacity, settings.filter.leaf_m));
    }
    result.points_mean += static_cast<double>(points_m.size()) / static_cast<double>(scans.size());

    const auto match_from = [&](const ndt::Pose& guess) {
      const double began_ms = thread_cpu_ms();
      const ndt::MatchResult match = matcher.match(map, points_m, guess);
      result.samples.push_back(compare(match, truth[i].pose, thread_cpu_ms() - began_ms));
      return match.pose;
    };
    if (settings.in_sequence) {
      track.push_back({truth[i].stamp_utc_ns, match_from(next_guess(track, truth[i]))});
    } else {
      for (std::size_t start = 0; start < settings.starts; ++start)
        match_from(perturbation.around(truth[i].pose));
    }
  }
  show_progress("");
  result.scans = scans.size();
  return result;
}

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(p * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace landfix::tools
