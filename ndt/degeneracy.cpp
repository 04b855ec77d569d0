#include "ndt/degeneracy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

namespace landfix::ndt {
namespace {

constexpr double kFeatureless = 3.0;  // times the lattice's pull
constexpr double kNothing = 0.5;      // less than even the lattice would: too few points to probe
constexpr double kFall = 0.05;        // of the score, half a voxel away

struct Eigenvectors {
  Twist values;     ///< ascending
  Matrix6 vectors;  ///< columns
};

/// Of a symmetric matrix, by Jacobi's rotations: Eigen's own solver has calls of the heap in it.
[[nodiscard]] Eigenvectors eigenvectors(Matrix6 matrix) noexcept {
  constexpr int kSweeps = 12;  // it converges quadratically: 5 or 6 do
  constexpr double kNegligible = 1e-12;
  Matrix6 vectors = Matrix6::Identity();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double diagonal = matrix.diagonal().squaredNorm();
    if (matrix.squaredNorm() - diagonal <= kNegligible * diagonal) break;
    for (int p = 0; p < 5; ++p) {
      for (int q = p + 1; q < 6; ++q) {
        Eigen::JacobiRotation<double> rotation;
        if (!rotation.makeJacobi(matrix, p, q)) continue;
        matrix.applyOnTheLeft(p, q, rotation.adjoint());
        matrix.applyOnTheRight(p, q, rotation);
        vectors.applyOnTheRight(p, q, rotation);
      }
    }
  }
  std::array<int, 6> order{};
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return matrix(a, a) < matrix(b, b); });
  Eigenvectors sorted;
  for (int i = 0; i < 6; ++i) {
    sorted.values[i] = matrix(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(i)]);
    sorted.vectors.col(i) = vectors.col(order[static_cast<std::size_t>(i)]);
  }
  return sorted;
}

/// Has the lattice's pull and no singular direction: a scan is at least as large as this.
[[nodiscard]] Matrix6 metric_of(const ScanInformation& information) noexcept {
  constexpr double kLeastSize_m = 0.1;
  Matrix6 metric = information.lattice;
  metric.diagonal().tail<3>().array() += kLeastSize_m * kLeastSize_m * metric(0, 0);
  return metric;
}

/// By how much of itself the score of every `stride`-th group falls at `step` to either side.
[[nodiscard]] double fall_of_score(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                   const Twist& step, std::size_t stride,
                                   const ScoreConstants& constants) noexcept {
  const auto score_at = [&](const Twist& offset) {
    double score = 0.0;
    for (std::size_t i = 0; i < groups.groups().size(); i += stride) {
      score += evaluate_group(map, groups, i, moved(pose, offset), Covariance::sharp, constants).score;
    }
    return score;
  };
  const double score = score_at(Twist::Zero());
  return score > 0.0 ? 1.0 - 0.5 * (score_at(step) + score_at(-step)) / score : 0.0;
}

/// Whether points stay in step with the voxels at `step` to either side. Few groups say so where it is not
/// close; to move all of them, and look up their pairs, would take as long as all the rest of a match.
[[nodiscard]] bool is_featureless(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                  const Twist& step, const ScoreConstants& constants) noexcept {
  constexpr std::size_t kFewGroups = 5;
  const std::size_t stride = groups.groups().size() / kFewGroups;
  if (stride > 1 && fall_of_score(map, groups, pose, step, stride, constants) > 3.0 * kFall) return false;
  return fall_of_score(map, groups, pose, step, 1, constants) < kFall;
}

}  // namespace

std::string_view to_string(Axis axis) noexcept {
  constexpr std::array<std::string_view, 6> kNames{"longitudinal", "lateral", "vertical",
                                                   "roll",         "pitch",   "yaw"};
  return kNames[static_cast<std::size_t>(axis)];
}

bool Directions::any_weak() const noexcept {
  return std::any_of(is_weak.begin(), is_weak.end(), [](bool weak) { return weak; });
}

Twist Directions::weak_part(const Twist& motion) const noexcept {
  const Twist measured = metric * motion;
  Twist part = Twist::Zero();
  for (int i = 0; i < 6; ++i) {
    if (is_weak[static_cast<std::size_t>(i)]) part += basis.col(i).dot(measured) * basis.col(i);
  }
  return part;
}

Directions find_directions(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                           const ScanInformation& information, const ScoreConstants& constants) noexcept {
  Directions directions;
  directions.metric = metric_of(information);
  const Eigen::LLT<Matrix6> llt(directions.metric);
  if (information.groups == 0 || llt.info() != Eigen::Success) return directions;
  directions.length_per_m = std::sqrt(directions.metric(0, 0));

  // The generalised eigenvectors of the pull and the metric. By columns: see pose_covariance.
  const auto lower = llt.matrixL();
  Matrix6 half;
  for (int i = 0; i < 6; ++i) half.col(i) = lower.solve(information.objective.definite.col(i).eval());
  Matrix6 ratio;
  for (int i = 0; i < 6; ++i) ratio.col(i) = lower.solve(half.row(i).transpose().eval());
  const Eigenvectors eigen = eigenvectors(ratio);
  for (int i = 0; i < 6; ++i) directions.basis.col(i) = llt.matrixU().solve(eigen.vectors.col(i).eval());

  for (int i = 0; i < 6 && eigen.values[i] < kFeatureless; ++i) {
    const Twist half_voxel = 0.5 * map.resolution_m() * directions.length_per_m * directions.basis.col(i);
    directions.is_weak[static_cast<std::size_t>(i)] =
        eigen.values[i] < kNothing || is_featureless(map, groups, pose, half_voxel, constants);
  }
  return directions;
}

WeakDirections name_weak(const Directions& directions, const Pose& pose,
                         const Matrix6& vehicle_covariance) noexcept {
  std::array<Twist, 6> weak;      // part of each axis, frame `map`
  std::array<double, 6> share{};  // that it is of the axis, in the metric
  for (std::size_t i = 0; i < 6; ++i) {
    Twist axis = Twist::Zero();
    const auto k = static_cast<Eigen::Index>(i);
    axis.segment<3>(k / 3 * 3) = pose.linear().col(k % 3);
    weak[i] = directions.weak_part(axis);
    share[i] = weak[i].dot(directions.metric * weak[i]) / axis.dot(directions.metric * axis);
  }
  WeakDirections named;
  const auto count = std::count(directions.is_weak.begin(), directions.is_weak.end(), true);
  while (named.count < static_cast<std::size_t>(count)) {
    const auto greatest =
        static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin());
    share[greatest] = -1.0;
    Twist direction;
    direction << pose.linear().transpose() * weak[greatest].head<3>(),
        pose.linear().transpose() * weak[greatest].tail<3>();
    const auto k = static_cast<Eigen::Index>(greatest);
    named.at[named.count++] = {.axis = static_cast<Axis>(greatest),
                               .direction = direction.normalized(),
                               .sigma = std::sqrt(vehicle_covariance(k, k))};
  }
  return named;
}

}  // namespace landfix::ndt
