#include "ndt/reference_matcher.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace landfix::ndt::test {

std::vector<ReferenceVoxel> reference_voxels(const VoxelMap& map, Covariance covariance) {
  std::vector<ReferenceVoxel> voxels;
  visit_voxels(map, [&](const Voxel& voxel, const Eigen::Vector3d& mean_m) {
    const Symmetric3f& c = covariance == Covariance::wide ? voxel.wide_1pm2 : voxel.sharp_1pm2;
    Eigen::Matrix3f inverse_covariance_1pm2;
    inverse_covariance_1pm2 << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    voxels.push_back({.mean_m = mean_m, .inverse_covariance_1pm2 = inverse_covariance_1pm2.cast<double>()});
  });
  return voxels;
}

std::vector<Pair> find_pairs(std::span<const ReferenceVoxel> voxels,
                             std::span<const Eigen::Vector3f> points_m, const Pose& pose,
                             double resolution_m) {
  std::vector<Pair> pairs;
  for (std::size_t point = 0; point < points_m.size(); ++point) {
    const Eigen::Vector3d place_m = pose * points_m[point].cast<double>();
    for (std::size_t voxel = 0; voxel < voxels.size(); ++voxel) {
      if ((place_m - voxels[voxel].mean_m).norm() <= resolution_m) pairs.push_back({point, voxel});
    }
  }
  return pairs;
}

ReferenceObjective evaluate_pairs(std::span<const ReferenceVoxel> voxels,
                                  std::span<const Eigen::Vector3f> points_m, std::span<const Pair> pairs,
                                  const Pose& pose, const ScoreConstants& constants) {
  ReferenceObjective sum;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d arm_m = pose.linear() * points_m[pair.point].cast<double>();
    const Eigen::Matrix3d& c = voxels[pair.voxel].inverse_covariance_1pm2;
    const Eigen::Vector3d e = arm_m + pose.translation() - voxels[pair.voxel].mean_m;
    const double score = constants.d1 * std::exp(-0.5 * constants.d2 * e.dot(c * e));

    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << Eigen::Matrix3d::Identity(), -skew(arm_m);
    const Twist slope = jacobian.transpose() * (c * e);
    Matrix6 bend = Matrix6::Zero();  // (C e) . d2 e / dw_i dw_j at 0 of exp(w) y: half of e_i x (e_j x y) +
                                     // e_j x (e_i x y)
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Eigen::Vector3d ei = Eigen::Vector3d::Unit(i);
        const Eigen::Vector3d ej = Eigen::Vector3d::Unit(j);
        bend(3 + i, 3 + j) = 0.5 * (c * e).dot(ei.cross(ej.cross(arm_m)) + ej.cross(ei.cross(arm_m)));
      }
    }
    const double weight = constants.d2 * score;
    const Matrix6 first_order =
        weight * (constants.d2 * slope * slope.transpose() - jacobian.transpose() * c * jacobian);
    sum.score += score;
    sum.gradient -= weight * slope;
    sum.hessian += first_order - weight * bend;
    sum.second_order_rotation -= weight * bend;
    sum.absolute_score += std::abs(score);
    sum.absolute_gradient += (weight * slope).cwiseAbs();
    sum.absolute_hessian += first_order.cwiseAbs() + (weight * bend).cwiseAbs();
  }
  return sum;
}

Pose perturbed(const Pose& pose, const Twist& step) {
  Pose result = pose;
  result.linear() = rotation_exp(step.tail<3>()) * pose.linear();
  result.translation() += step.head<3>();
  return result;
}

Pose match(std::span<const ReferenceVoxel> voxels, std::span<const Eigen::Vector3f> points_m,
           const Pose& guess, double resolution_m, const ScoreConstants& constants) {
  const auto at = [&](const Pose& pose) {
    return evaluate_pairs(voxels, points_m, find_pairs(voxels, points_m, pose, resolution_m), pose,
                          constants);
  };
  Pose pose = guess;
  ReferenceObjective objective = at(pose);
  double damping = 0.0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    // Shift the eigenvalues of -H, scaled to a unit diagonal, until all are positive.
    const Twist scale = objective.absolute_hessian.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix6 descent = -(scale.asDiagonal() * objective.hessian * scale.asDiagonal());
    const double lowest = Eigen::SelfAdjointEigenSolver<Matrix6>(descent).eigenvalues().minCoeff();
    const Matrix6 safe = descent + (damping + std::max(0.0, 1e-3 - lowest)) * Matrix6::Identity();
    Twist step = scale.cwiseProduct(safe.ldlt().solve(scale.cwiseProduct(objective.gradient)).eval());
    step *= std::min({1.0, 0.3 / step.head<3>().norm(), 0.03 / step.tail<3>().norm()});
    if (step.head<3>().norm() < 1e-7 && step.tail<3>().norm() < 1e-8) break;
    const Pose next = perturbed(pose, step);
    const ReferenceObjective there = at(next);
    if (there.score >= objective.score) {
      pose = next;
      objective = there;
      damping *= 0.1;
    } else {
      damping = std::max(10.0 * damping, 0.1);
      if (damping > 1e6) break;
    }
  }
  return pose;
}

}  // namespace landfix::ndt::test
