#include "ndt/scan_information.hpp"

#include <span>

namespace landfix::ndt {
namespace {

/// The mean over the points p, seen from the vehicle in map axes, of J' J with J = [I, -skew(p)]: a twist e
/// displaces them by sqrt(e' J'J e), root mean square.
[[nodiscard]] Matrix6 mean_square_displacement(std::span<const Eigen::Vector3f> points_m,
                                               const Eigen::Vector3d& centre_m, const Pose& pose) noexcept {
  Eigen::Matrix3f second_moment_m2 = Eigen::Matrix3f::Zero();  // about the centre
  for (const Eigen::Vector3f& p : points_m) second_moment_m2.noalias() += p * p.transpose();
  const Eigen::Matrix3d moment_m2 = pose.linear() *
                                    (second_moment_m2.cast<double>() / static_cast<double>(points_m.size()) +
                                     centre_m * centre_m.transpose())
                                        .eval() *
                                    pose.linear().transpose();
  const Eigen::Matrix3d arm = skew(pose.linear() * centre_m);
  Matrix6 square;
  square.topLeftCorner<3, 3>().setIdentity();
  square.topRightCorner<3, 3>() = -arm;
  square.bottomLeftCorner<3, 3>() = arm;
  square.bottomRightCorner<3, 3>() = moment_m2.trace() * Eigen::Matrix3d::Identity() - moment_m2;
  return square;
}

}  // namespace

ScanInformation gather_information(const VoxelMap& map, PairGroups& groups, const Pose& pose,
                                   Covariance covariance, const ScoreConstants& constants) noexcept {
  const double pull_1pm2 = constants.d2 * 12.0 / (map.resolution_m() * map.resolution_m());
  ScanInformation sum;
  for (std::size_t i = 0; i < groups.groups().size(); ++i) {
    const Objective part = evaluate_group(map, groups, i, pose, covariance, constants);
    if (part.pairs == 0) continue;
    const Eigen::Matrix<double, 6, 3> displacement =
        part.definite.leftCols<3>() - part.curvature.leftCols<3>();
    ++sum.groups;
    sum.objective.pairs += part.pairs;
    sum.objective.score += part.score;
    sum.objective.gradient += part.gradient;
    sum.objective.definite += part.definite;
    sum.objective.curvature += part.curvature;
    sum.scatter.noalias() += part.gradient * part.gradient.transpose();
    sum.displacement.noalias() += displacement * displacement.transpose();
    sum.lattice += pull_1pm2 * part.score *
                   mean_square_displacement(groups.points_m(i), groups.groups()[i].centre_m, pose);
  }
  return sum;
}

}  // namespace landfix::ndt
