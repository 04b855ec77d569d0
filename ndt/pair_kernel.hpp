// The inner loop of matching: what the pairs of one group add up to, several at a time. One source serves
// every instruction set (Highway); which is used is found out once, at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ndt/pair_groups.hpp"
#include "ndt/score.hpp"

namespace landfix::ndt {

/// Where a group is: rotation of the pose, and the group's centre seen from the origin of its means.
struct GroupPlace {
  std::array<float, 9> rotation{};  ///< row-major
  std::array<float, 3> centre_m{};
  float radius_m2 = 0.0F;  ///< pairs farther apart are none
};

/// With u = (C d, y x C d), J = [I, -skew(y)] and weight w = d2 s, where d is point - mean and y the point
/// seen from the group's centre, both in map axes. Symmetric matrices by rows of their upper triangle.
struct GroupSums {
  float pairs = 0.0F;
  float score = 0.0F;                 ///< of s
  std::array<float, 6> gradient{};    ///< of -w u
  std::array<float, 21> definite{};   ///< of w J' C J
  std::array<float, 21> curvature{};  ///< of w d2 u u'
};
inline constexpr std::size_t kGroupSumCount = 50;
static_assert(sizeof(GroupSums) == kGroupSumCount * sizeof(float));

/// `count`: candidates in `columns`.
[[nodiscard]] GroupSums sum_pairs(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                                  const ScoreConstants& constants) noexcept;

/// Each candidate's s at the place, above 0; 0 where it is no pair.
void score_pairs(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                 const ScoreConstants& constants, std::span<float, kGroupPairs> scores) noexcept;

}  // namespace landfix::ndt
