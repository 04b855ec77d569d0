#include "ndt/objective.hpp"

#include <algorithm>
#include <cmath>

namespace landfix::ndt {
namespace {

using Matrix3f = Eigen::Matrix3f;
using Vector3f = Eigen::Vector3f;

[[nodiscard]] Matrix3f to_matrix(const Symmetric3f& s) noexcept {
  Matrix3f m;
  m << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return m;
}

/// What the pairs of one point add up to, before its lever arm enters: all pairs of a point share its
/// Jacobian J = [I, -skew(y)], so J is applied once a point, not once a pair.
struct PointSums {
  float score = 0.0F;
  float best_score = 0.0F;
  int pairs = 0;
  Vector3f gradient = Vector3f::Zero();
  Matrix3f definite = Matrix3f::Zero();
  Matrix3f curvature = Matrix3f::Zero();
};

void add_pair(PointSums& sums, const Matrix3f& inverse_covariance, const Vector3f& difference_m, float d1,
              float d2) noexcept {
  const Vector3f pull = inverse_covariance * difference_m;
  const float score = d1 * std::exp(-0.5F * d2 * difference_m.dot(pull));
  const float weight = d2 * score;
  sums.score += score;
  sums.best_score = std::max(sums.best_score, score);
  ++sums.pairs;
  sums.gradient -= weight * pull;
  sums.definite += weight * inverse_covariance;
  sums.curvature += (weight * d2) * pull * pull.transpose();
}

/// target += J' m J for the symmetric m.
void add_sandwich(Matrix6& target, const Eigen::Matrix3d& m, const Eigen::Matrix3d& lever) noexcept {
  const Eigen::Matrix3d m_lever = m * lever;
  target.topLeftCorner<3, 3>() += m;
  target.topRightCorner<3, 3>() -= m_lever;
  target.bottomRightCorner<3, 3>() -= lever * m_lever;  // lever' = -lever
}

void mirror(Matrix6& m) noexcept { m.bottomLeftCorner<3, 3>() = m.topRightCorner<3, 3>().transpose(); }

}  // namespace

Objective evaluate(const VoxelMap& map, std::span<const Vector3f> points_m, const Pose& pose,
                   Covariance covariance, const ScoreConstants& constants) noexcept {
  const double resolution_m = map.resolution_m();
  const double inverse_resolution_1pm = 1.0 / resolution_m;
  const auto d1 = static_cast<float>(constants.d1);
  const auto d2 = static_cast<float>(constants.d2);
  const auto inverse_covariance = covariance == Covariance::wide ? &Voxel::wide_1pm2 : &Voxel::sharp_1pm2;

  Objective sum;
  for (const Vector3f& point_m : points_m) {
    const Eigen::Vector3d arm_m = pose.linear() * point_m.cast<double>();
    const LatticePoint place = to_lattice(arm_m + pose.translation(), resolution_m, inverse_resolution_1pm);
    PointSums point;
    map.visit_near(place, [&](const Voxel& voxel, const Vector3f& difference_m) {
      add_pair(point, to_matrix(voxel.*inverse_covariance), difference_m, d1, d2);
    });
    if (point.pairs == 0) continue;
    ++sum.points_matched;
    sum.pairs += static_cast<std::size_t>(point.pairs);
    sum.score += static_cast<double>(point.score);
    sum.best_score_sum += static_cast<double>(point.best_score);
    const Eigen::Vector3d gradient = point.gradient.cast<double>();
    sum.gradient.head<3>() += gradient;
    sum.gradient.tail<3>() += arm_m.cross(gradient);
    const Eigen::Matrix3d lever = skew(arm_m);
    add_sandwich(sum.definite, point.definite.cast<double>(), lever);
    add_sandwich(sum.curvature, point.curvature.cast<double>(), lever);
  }
  mirror(sum.definite);
  mirror(sum.curvature);
  return sum;
}

}  // namespace landfix::ndt
