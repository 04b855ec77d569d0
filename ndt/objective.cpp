#include "ndt/objective.hpp"

#include <algorithm>
#include <array>

#include "ndt/pair_kernel.hpp"

namespace landfix::ndt {
namespace {

[[nodiscard]] Matrix6 to_matrix(const std::array<float, 21>& upper) noexcept {
  Matrix6 matrix;
  std::size_t n = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) matrix(i, j) = matrix(j, i) = static_cast<double>(upper[n++]);
  }
  return matrix;
}

/// T' H T of a symmetric H, where T takes a twist about the vehicle to one about a point that is `arm_m` from
/// it: v + w x arm, w. By blocks, since three quarters of T are 0 or 1.
[[nodiscard]] Matrix6 about_the_vehicle(const Matrix6& hessian, const Eigen::Matrix3d& arm_skew_m) noexcept {
  const Eigen::Matrix3d translation = hessian.topLeftCorner<3, 3>();
  const Eigen::Matrix3d mixed = hessian.topRightCorner<3, 3>();
  const Eigen::Matrix3d moved = translation * arm_skew_m;
  const Eigen::Matrix3d turned = arm_skew_m * (mixed - 0.5 * moved);
  Matrix6 result = hessian;
  result.topRightCorner<3, 3>() -= moved;
  result.bottomLeftCorner<3, 3>() = result.topRightCorner<3, 3>().transpose();
  result.bottomRightCorner<3, 3>() += turned + turned.transpose();
  return result;
}

[[nodiscard]] GroupPlace place_of(const PairGroup& group, double resolution_m, const Reach& reach,
                                  const Pose& pose) noexcept {
  GroupPlace place;
  for (int i = 0; i < 9; ++i) {
    place.rotation[static_cast<std::size_t>(i)] = static_cast<float>(pose.linear()(i / 3, i % 3));
  }
  const Eigen::Vector3d origin_m =
      resolution_m * Eigen::Vector3d(group.origin.i, group.origin.j, group.origin.k);
  const Eigen::Vector3f centre_m = (pose * group.centre_m - origin_m).cast<float>();
  place.centre_m = {centre_m.x(), centre_m.y(), centre_m.z()};
  const double radius_m = reach.pair * resolution_m;
  place.radius_m2 = static_cast<float>(radius_m * radius_m);
  return place;
}

void add_group(const VoxelMap& map, PairGroups& groups, std::size_t index, const Pose& pose,
               Covariance covariance, const ScoreConstants& constants, Objective& sum) noexcept {
  groups.update(map, pose, covariance, index);
  const PairGroup& group = groups.groups()[index];
  if (group.pair_count == 0) return;
  const GroupSums part = sum_pairs(groups.columns(index), group.pair_count,
                                   place_of(group, map.resolution_m(), groups.reach(), pose), constants);
  const Eigen::Vector3d arm_m = pose.linear() * group.centre_m;
  const Eigen::Matrix3d arm_skew_m = skew(arm_m);
  const Eigen::Vector3d pull = Eigen::Map<const Eigen::Vector3f>(part.gradient.data()).cast<double>();
  const Eigen::Vector3d turn = Eigen::Map<const Eigen::Vector3f>(part.gradient.data() + 3).cast<double>();
  sum.pairs += static_cast<std::size_t>(part.pairs);
  sum.score += static_cast<double>(part.score);
  sum.gradient.head<3>() += pull;
  sum.gradient.tail<3>() += turn + arm_m.cross(pull);
  sum.definite += about_the_vehicle(to_matrix(part.definite), arm_skew_m);
  sum.curvature += about_the_vehicle(to_matrix(part.curvature), arm_skew_m);
}

}  // namespace

Objective evaluate(const VoxelMap& map, PairGroups& groups, const Pose& pose, Covariance covariance,
                   const ScoreConstants& constants) noexcept {
  Objective sum;
  for (std::size_t i = 0; i < groups.groups().size(); ++i) {
    add_group(map, groups, i, pose, covariance, constants, sum);
  }
  return sum;
}

Objective evaluate_group(const VoxelMap& map, PairGroups& groups, std::size_t group, const Pose& pose,
                         Covariance covariance, const ScoreConstants& constants) noexcept {
  Objective part;
  add_group(map, groups, group, pose, covariance, constants, part);
  return part;
}

PointScores score_points(const VoxelMap& map, PairGroups& groups, const Pose& pose, Covariance covariance,
                         const ScoreConstants& constants) noexcept {
  PointScores total;
  std::array<float, kGroupPairs> scores;
  for (std::size_t i = 0; i < groups.groups().size(); ++i) {
    groups.update(map, pose, covariance, i);
    const PairGroup& group = groups.groups()[i];
    const PairColumns& columns = groups.columns(i);
    score_pairs(columns, group.pair_count, place_of(group, map.resolution_m(), groups.reach(), pose),
                constants, scores);
    float sum = 0.0F;
    std::array<float, kGroupPoints> best{};  // what is no pair scores 0, and nothing else does
    for (std::size_t n = 0; n < group.pair_count; ++n) {
      float& of_point = best[columns.point[n]];
      of_point = std::max(of_point, scores[n]);
      sum += scores[n];
    }
    total.sum += static_cast<double>(sum);
    const auto points_m = groups.points_m(i);
    const auto above_ground_m = static_cast<float>(kAboveGround_m - group.centre_m.z());
    for (std::size_t p = 0; p < group.point_count; ++p) {
      if (best[p] == 0.0F) continue;
      const auto score = static_cast<double>(best[p]);
      total.all.add(score);
      if (points_m[p].z() > above_ground_m) total.no_ground.add(score);
    }
  }
  return total;
}

}  // namespace landfix::ndt
