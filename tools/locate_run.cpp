#include "tools/locate_run.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "ndt/relocalizer.hpp"
#include "platform/atomic_file.hpp"
#include "tools/benchmark_statistics.hpp"
#include "tools/command.hpp"
#include "tools/cpu_clock.hpp"

namespace landfix::tools {
namespace {

constexpr double kRight_m = 0.1;
constexpr double kRight_rad = 0.5 * kRadians_per_deg;

[[nodiscard]] LocatedScan judge(const ndt::Location& location, const ndt::Pose& truth) {
  LocatedScan result;
  if (location.candidates.empty()) return result;
  const ndt::Candidate& first = location.candidates[0];
  result.found = true;
  result.error_m = (first.match.pose.translation() - truth.translation()).norm();
  result.error_rad = ndt::angle_between(first.match.pose, truth);
  result.right = result.error_m < kRight_m && result.error_rad < kRight_rad;
  result.sure = location.sure;
  result.confidence = location.confidence;
  result.explained = first.match.standing_explained();
  result.plan_score = first.plan_score;
  for (const ndt::Candidate& rival : location.candidates.subspan(1))
    result.rival_explained = std::max(result.rival_explained, rival.match.standing_explained());
  return result;
}

struct LocateSummary {
  explicit LocateSummary(std::span<const LocatedScan> scans) : all(scans.size()) {
    std::vector<double> seconds;
    for (const LocatedScan& scan : scans) {
      right += scan.right ? 1 : 0;
      sure += scan.sure ? 1 : 0;
      wrong_and_sure += scan.sure && !scan.right ? 1 : 0;
      seconds.push_back(scan.seconds);
    }
    median_s = quantile(seconds, 0.5);
    p99_s = quantile(seconds, 0.99);
    longest_s = quantile(seconds, 1.0);
  }

  [[nodiscard]] double percent(std::size_t count) const {
    return 100.0 * static_cast<double>(count) / static_cast<double>(all);
  }

  std::size_t all;
  std::size_t right = 0;
  std::size_t sure = 0;
  std::size_t wrong_and_sure = 0;
  double median_s = 0.0;
  double p99_s = 0.0;
  double longest_s = 0.0;
};

}  // namespace

std::vector<LocatedScan> locate_all(const ndt::VoxelMap& map, const ndt::PlanView& plan,
                                    std::span<const std::filesystem::path> scans,
                                    std::span<const ndt::StampedPose> truth, const LocateSettings& settings) {
  std::vector<LocatedScan> results;
  ndt::Relocalizer relocalizer(plan);
  for (std::size_t i = 0; i < scans.size(); i += settings.every) {
    show_progress(fmt::format("scan {} of {}", i + 1, scans.size()));
    const auto scan = load_scan(scans[i], settings.limits);
    ndt::ScanFilter filter(settings.filter, scan.size());
    filter.add(scan, elevation_steps(scan));
    const auto points_m = filter.finish();
    std::optional<ndt::PoseGuess> area;
    if (settings.within_m)
      area = {.position_m = truth[i].pose.translation().head<2>(), .within_m = *settings.within_m};
    ndt::Location location;
    const double cpu_ms = cpu_ms_of([&] { location = relocalizer.locate(map, points_m, area); });
    results.push_back(judge(location, truth[i].pose));
    results.back().name = scans[i].filename();
    results.back().seconds = 1e-3 * cpu_ms;
  }
  show_progress("");
  return results;
}

void write_table(const std::filesystem::path& path, std::span<const LocatedScan> scans) {
  platform::AtomicFile file(path);
  file.write(
      "scan,found,right,sure,confidence,error_m,error_deg,explained,rival_explained,plan_score,cpu_s\n");
  for (const LocatedScan& scan : scans) {
    file.write(fmt::format("{},{:d},{:d},{:d},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f},{},{:.4f}\n", scan.name,
                           scan.found, scan.right, scan.sure, scan.confidence, scan.error_m,
                           scan.error_rad / kRadians_per_deg, scan.explained, scan.rival_explained,
                           scan.plan_score, scan.seconds));
  }
  file.commit();
}

nlohmann::json to_json(std::span<const LocatedScan> scans, const ndt::PlanView& plan) {
  const LocateSummary summary(scans);
  return {{"scans", summary.all},
          {"right", summary.right},
          {"sure", summary.sure},
          {"wrong_and_sure", summary.wrong_and_sure},
          {"cpu_s", {{"median", summary.median_s}, {"p99", summary.p99_s}, {"max", summary.longest_s}}},
          {"ground_m2", plan.area_m2()},
          {"plan_bytes", plan.memory_bytes()}};
}

std::string to_text(std::span<const LocatedScan> scans, const ndt::PlanView& plan) {
  const LocateSummary summary(scans);
  std::string text = fmt::format(
      "scans             {}, in a map with {:.0f} m^2 of ground ({:.1f} MB to search it)\n"
      "right             {} ({:.1f} %), within 10 cm and 0.5 deg\n"
      "sure              {} ({:.1f} %), of these wrong {}\n"
      "CPU time          median {:.3f} s, p99 {:.3f} s, longest {:.3f} s\n",
      summary.all, plan.area_m2(), 1e-6 * static_cast<double>(plan.memory_bytes()), summary.right,
      summary.percent(summary.right), summary.sure, summary.percent(summary.sure), summary.wrong_and_sure,
      summary.median_s, summary.p99_s, summary.longest_s);
  constexpr std::size_t kMostNamed = 10;
  std::size_t named = 0;
  for (const LocatedScan& scan : scans) {
    if (scan.right || named++ == kMostNamed) continue;
    text += scan.found
                ? fmt::format("not right         {}: {:.2f} m, {:.2f} deg off, confidence {:.3f}\n",
                              scan.name, scan.error_m, scan.error_rad / kRadians_per_deg, scan.confidence)
                : fmt::format("not found         {}\n", scan.name);
    if (named == kMostNamed) break;
  }
  return text;
}

}  // namespace landfix::tools
