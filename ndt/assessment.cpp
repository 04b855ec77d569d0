#include "ndt/assessment.hpp"

#include "ndt/covariance.hpp"

namespace landfix::ndt {
namespace {

/// Where the guess's part leads to, the held directions have a little way to go to their optimum: one step of
/// Newton's, if it is small and raises the score.
[[nodiscard]] Pose polished(const VoxelMap& map, PairGroups& groups, const Pose& pose, Covariance covariance,
                            const ScoreConstants& constants, const Directions& directions) noexcept {
  constexpr double kSmall_m = 0.2;
  constexpr double kSmall_rad = 0.02;
  const Objective before = evaluate(map, groups, pose, covariance, constants);
  const Twist step = held_step(before, directions);
  if (!(step.head<3>().norm() < kSmall_m && step.tail<3>().norm() < kSmall_rad)) return pose;
  const Pose after = moved(pose, step);
  return evaluate(map, groups, after, covariance, constants).score > before.score ? after : pose;
}

}  // namespace

Assessment assess(const VoxelMap& map, PairGroups& groups, const Pose& optimum, Covariance covariance,
                  const ScanInformation& sharp, const ScoreConstants& constants,
                  const Guess& guess) noexcept {
  const ScanInformation information = covariance == Covariance::sharp
                                          ? sharp
                                          : gather_information(map, groups, optimum, covariance, constants);
  const Directions directions = find_directions(map, groups, optimum, sharp, constants);
  Assessment assessment{.pose = optimum,
                        .covariance = pose_covariance(information, directions, optimum, guess.sigma_m)};
  if (!directions.any_weak()) return assessment;
  const Twist from_guess = directions.weak_part(step_between(guess.pose, optimum));
  assessment.pose = polished(map, groups, moved(optimum, -from_guess), covariance, constants, directions);
  assessment.weak = name_weak(directions, optimum, to_vehicle_covariance(assessment.covariance, optimum));
  return assessment;
}

}  // namespace landfix::ndt
