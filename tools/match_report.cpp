#include "tools/match_report.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "ndt/localizer.hpp"
#include "tools/input_files.hpp"

namespace landfix::tools {
namespace {

/// Sigma in m along an axis, in deg about one.
[[nodiscard]] double sigma_of(const ndt::WeakDirection& weak) {
  return weak.axis < ndt::Axis::roll ? weak.sigma : weak.sigma / kRadians_per_deg;
}

[[nodiscard]] nlohmann::json weak_to_json(const ndt::WeakDirections& weak) {
  nlohmann::json list = nlohmann::json::array();
  for (const ndt::WeakDirection& direction : weak.all()) {
    list.push_back(
        {{"axis", ndt::to_string(direction.axis)},
         {"direction", std::vector<double>(direction.direction.begin(), direction.direction.end())},
         {direction.axis < ndt::Axis::roll ? "sigma_m" : "sigma_deg", sigma_of(direction)}});
  }
  return list;
}

[[nodiscard]] std::string held_to_text(const ndt::MatchResult& result) {
  if (result.points_matched == 0) return "none: the map has nothing near";
  std::string text;
  for (const ndt::WeakDirection& direction : result.weak.all()) {
    text += fmt::format("{}{} (1 sigma {:.3f} {})", text.empty() ? "" : ", ", ndt::to_string(direction.axis),
                        sigma_of(direction), direction.axis < ndt::Axis::roll ? "m" : "deg");
  }
  return text.empty() ? "all" : "not " + text + ": as in the guess";
}

[[nodiscard]] const char* explain(ndt::Fit fit) {
  switch (fit) {
    case ndt::Fit::good:
      return "good";
    case ndt::Fit::weak:
      return "weak: the map explains only a part of the scan, or does not hold it closely";
    case ndt::Fit::none:
      break;
  }
  return "none: do not believe this pose; try another --guess";
}

}  // namespace

nlohmann::json match_to_json(const ndt::MatchResult& result, double fitness_score, double match_ms) {
  // Row-major; the matrix is symmetric, so Eigen's order does not matter.
  const std::vector<double> covariance(result.covariance.data(),
                                       result.covariance.data() + result.covariance.size());
  return {{"converged", result.converged},
          {"pose", pose_to_json(result.pose)},
          {"covariance", covariance},
          {"iterations", result.iterations},
          {"fitness_score", fitness_score},
          {"transformation_probability", result.transformation_probability},
          {"nearest_voxel_likelihood", result.nearest_voxel_likelihood},
          {"no_ground_nearest_voxel_likelihood", result.no_ground_nearest_voxel_likelihood},
          {"no_ground_points", result.no_ground_points},
          {"no_ground_points_matched", result.no_ground_points_matched},
          {"weak_directions", weak_to_json(result.weak)},
          {"match_ms", match_ms},
          {"points", result.points},
          {"points_matched", result.points_matched},
          {"fit", ndt::to_string(ndt::judge(result, {}))}};
}

std::string match_to_text(const ndt::MatchResult& result, double fitness_score, double match_ms) {
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(result.pose.linear());
  const auto& t = result.pose.translation();
  const auto sigma = [&result](int axis) { return std::sqrt(result.covariance(axis, axis)); };
  return fmt::format(
      "{}\n"
      "position          {:.4f} {:.4f} {:.4f} m\n"
      "roll pitch yaw    {:.4f} {:.4f} {:.4f} deg\n"
      "1 sigma           {:.4f} {:.4f} {:.4f} m, {:.4f} {:.4f} {:.4f} deg\n"
      "iterations        {}\n"
      "fitness score     {:.6f} m^2 (mean squared distance to the nearest voxel's mean)\n"
      "transformation probability {:.4f}, nearest voxel likelihood {:.4f}, above the ground {:.4f}\n"
      "points            {}, {} with a voxel near\n"
      "directions held   {}\n"
      "fit               {}\n"
      "match             {:.3f} ms\n",
      result.converged ? "converged" : "NOT converged: the guess may be too far from the truth", t.x(), t.y(),
      t.z(), angles.roll_rad / kRadians_per_deg, angles.pitch_rad / kRadians_per_deg,
      angles.yaw_rad / kRadians_per_deg, sigma(0), sigma(1), sigma(2), sigma(3) / kRadians_per_deg,
      sigma(4) / kRadians_per_deg, sigma(5) / kRadians_per_deg, result.iterations, fitness_score,
      result.transformation_probability, result.nearest_voxel_likelihood,
      result.no_ground_nearest_voxel_likelihood, result.points, result.points_matched, held_to_text(result),
      explain(ndt::judge(result, {})), match_ms);
}

}  // namespace landfix::tools
