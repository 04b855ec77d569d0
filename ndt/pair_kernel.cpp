#include "ndt/pair_kernel.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "ndt/simd_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ndt/pair_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// NOLINTBEGIN(modernize-concat-nested-namespaces): Highway compiles this part once an instruction set.
HWY_BEFORE_NAMESPACE();
namespace landfix::ndt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// At most 16 lanes: columns are padded to that.
using Floats = hn::CappedTag<float, 16>;
using V = hn::Vec<Floats>;

/// e^x for x in [-87, 0], to 2 units in the last place: 2^n times a polynomial on [-ln2/2, ln2/2].
HWY_INLINE V exp_negative(V x) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const V clamped = hn::Max(x, hn::Set(d, -87.0F));
  const V n = hn::Round(hn::Mul(clamped, hn::Set(d, 1.44269504F)));
  // ln 2 in two parts, so that the difference keeps its digits (Cody and Waite).
  const V r =
      hn::NegMulAdd(n, hn::Set(d, -2.12194440e-4F), hn::NegMulAdd(n, hn::Set(d, 0.693359375F), clamped));
  V p = hn::Set(d, 1.0F / 720.0F);
  p = hn::MulAdd(p, r, hn::Set(d, 1.0F / 120.0F));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0F / 24.0F));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0F / 6.0F));
  p = hn::MulAdd(p, r, hn::Set(d, 0.5F));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0F));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0F));
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, n), hn::Set(di, 127)));
  return hn::Mul(p, hn::BitCast(d, exponent));
}

struct Vector {
  V x;
  V y;
  V z;
};

HWY_INLINE V dot(const Vector& a, const Vector& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

HWY_INLINE void add(V& sum, V a, V b) { sum = hn::MulAdd(a, b, sum); }

/// w J' C J with J = [I, -S], S = skew(y): C, -C S, S' C S.
HWY_INLINE void add_definite(V* sums, const Vector (&c)[3], const Vector& y, V weight) {
  // Rows of C S.
  const Vector cs[3] = {cross(c[0], y), cross(c[1], y), cross(c[2], y)};
  const V minus_weight = hn::Neg(weight);
  add(sums[0], weight, c[0].x);
  add(sums[1], weight, c[0].y);
  add(sums[2], weight, c[0].z);
  add(sums[3], minus_weight, cs[0].x);
  add(sums[4], minus_weight, cs[0].y);
  add(sums[5], minus_weight, cs[0].z);
  add(sums[6], weight, c[1].y);
  add(sums[7], weight, c[1].z);
  add(sums[8], minus_weight, cs[1].x);
  add(sums[9], minus_weight, cs[1].y);
  add(sums[10], minus_weight, cs[1].z);
  add(sums[11], weight, c[2].z);
  add(sums[12], minus_weight, cs[2].x);
  add(sums[13], minus_weight, cs[2].y);
  add(sums[14], minus_weight, cs[2].z);
  // S' (C S) = -S (C S): minus y x each column.
  const Vector column_x = cross(y, {cs[0].x, cs[1].x, cs[2].x});
  const Vector column_y = cross(y, {cs[0].y, cs[1].y, cs[2].y});
  const Vector column_z = cross(y, {cs[0].z, cs[1].z, cs[2].z});
  add(sums[15], minus_weight, column_x.x);
  add(sums[16], minus_weight, column_y.x);
  add(sums[17], minus_weight, column_z.x);
  add(sums[18], minus_weight, column_y.y);
  add(sums[19], minus_weight, column_z.y);
  add(sums[20], minus_weight, column_z.z);
}

HWY_INLINE void add_outer(V* sums, const V (&u)[6], V weight) {
  for (int i = 0, n = 0; i < 6; ++i) {
    const V weighted = hn::Mul(weight, u[i]);
    for (int j = i; j < 6; ++j) add(sums[n++], weighted, u[j]);
  }
}

/// The candidates from `i` on, as vectors. Made in one piece: a constructor of the compiler's own would not
/// be compiled for the instruction set, and on Arm not at all.
struct Candidates {
  Vector c[3];  ///< rows of the inverse covariance
  Vector arm;   ///< the point from the group's centre, map axes
  Vector pull;  ///< C times the point's difference from the mean
  V distance;   ///< squared, of Mahalanobis
  hn::Mask<Floats> is_pair;
};

HWY_INLINE Candidates candidates(const PairColumns& columns, std::size_t i, std::size_t count,
                                 const GroupPlace& place) {
  const Floats d;
  const auto load = [&](const auto& column) HWY_ATTR { return hn::Load(d, column.data() + i); };
  const auto set = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto& r = place.rotation;
  const auto& shape = columns.inverse_covariance_1pm2;
  const V xy = load(shape[1]);
  const V xz = load(shape[2]);
  const V yz = load(shape[4]);
  const Vector c[3] = {{load(shape[0]), xy, xz}, {xy, load(shape[3]), yz}, {xz, yz, load(shape[5])}};
  const Vector p{load(columns.point_m[0]), load(columns.point_m[1]), load(columns.point_m[2])};
  const Vector arm{dot({set(r[0]), set(r[1]), set(r[2])}, p), dot({set(r[3]), set(r[4]), set(r[5])}, p),
                   dot({set(r[6]), set(r[7]), set(r[8])}, p)};
  const Vector difference{hn::Add(arm.x, hn::Sub(set(place.centre_m[0]), load(columns.mean_m[0]))),
                          hn::Add(arm.y, hn::Sub(set(place.centre_m[1]), load(columns.mean_m[1]))),
                          hn::Add(arm.z, hn::Sub(set(place.centre_m[2]), load(columns.mean_m[2])))};
  const Vector pull{dot(c[0], difference), dot(c[1], difference), dot(c[2], difference)};
  return {.c = {c[0], c[1], c[2]},
          .arm = arm,
          .pull = pull,
          .distance = dot(difference, pull),
          .is_pair =
              hn::And(hn::Le(dot(difference, difference), set(place.radius_m2)), hn::FirstN(d, count - i))};
}

/// d1 exp(-d2/2 distance) of those that are pairs, 0 of the others.
HWY_INLINE V score_of(const Candidates& all, V d1, V d2) {
  const V exponent = hn::Mul(hn::Mul(hn::Set(Floats(), -0.5F), d2), all.distance);
  return hn::IfThenElseZero(all.is_pair, hn::Mul(d1, exp_negative(exponent)));
}

HWY_ATTR void score_pairs_simd(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                               const ScoreConstants& constants, float* scores) {
  const Floats d;
  const V d1 = hn::Set(d, static_cast<float>(constants.d1));
  const V d2 = hn::Set(d, static_cast<float>(constants.d2));
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(score_of(candidates(columns, i, count, place), d1, d2), d, scores + i);
  }
}

/// Candidates that are worked on at a time. One loop would need a running sum for each of 50 numbers, more
/// than there are registers; of three in turn, each keeps its own.
constexpr std::size_t kStretch = 128;

/// Of each candidate of a stretch, what the sums of second order are made of.
struct alignas(64) Stretch {
  template <std::size_t n>
  using Rows = std::array<std::array<float, kStretch>, n>;

  Rows<3> arm_m;
  Rows<6> gradient;  ///< of half the squared distance
  Rows<1> weight;    ///< 0 where it is no pair
};

HWY_INLINE V load(const std::array<float, kStretch>& row, std::size_t i) {
  return hn::Load(Floats(), row.data() + i);
}

/// Adds the number of pairs, the score and its gradient; fills the stretch, which begins at `first`.
HWY_INLINE void add_first_order(const PairColumns& columns, std::size_t first, std::size_t count,
                                const GroupPlace& place, const ScoreConstants& constants, V* sums,
                                Stretch& stretch) {
  const Floats d;
  const V d1 = hn::Set(d, static_cast<float>(constants.d1));
  const V d2 = hn::Set(d, static_cast<float>(constants.d2));
  V sum[8];
  for (int k = 0; k < 8; ++k) sum[k] = sums[k];
  for (std::size_t i = 0; i < std::min(kStretch, count - first); i += hn::Lanes(d)) {
    const Candidates all = candidates(columns, first + i, count, place);
    const V score = score_of(all, d1, d2);
    const V weight = hn::Mul(d2, score);
    const Vector turn = cross(all.arm, all.pull);
    const V u[6] = {all.pull.x, all.pull.y, all.pull.z, turn.x, turn.y, turn.z};
    sum[0] = hn::Add(sum[0], hn::IfThenElseZero(all.is_pair, hn::Set(d, 1.0F)));
    sum[1] = hn::Add(sum[1], score);
    for (std::size_t k = 0; k < 6; ++k) {
      sum[2 + k] = hn::NegMulAdd(weight, u[k], sum[2 + k]);
      hn::Store(u[k], d, stretch.gradient[k].data() + i);
    }
    hn::Store(all.arm.x, d, stretch.arm_m[0].data() + i);
    hn::Store(all.arm.y, d, stretch.arm_m[1].data() + i);
    hn::Store(all.arm.z, d, stretch.arm_m[2].data() + i);
    hn::Store(weight, d, stretch.weight[0].data() + i);
  }
  for (int k = 0; k < 8; ++k) sums[k] = sum[k];
}

HWY_INLINE void add_all_definite(const PairColumns& columns, std::size_t first, std::size_t count,
                                 const Stretch& stretch, V* sums) {
  const Floats d;
  V sum[21];
  for (int k = 0; k < 21; ++k) sum[k] = sums[k];
  for (std::size_t i = 0; i < std::min(kStretch, count - first); i += hn::Lanes(d)) {
    const auto shape = [&](std::size_t k) HWY_ATTR {
      return hn::Load(d, columns.inverse_covariance_1pm2[k].data() + first + i);
    };
    const V xy = shape(1);
    const V xz = shape(2);
    const V yz = shape(4);
    const Vector c[3] = {{shape(0), xy, xz}, {xy, shape(3), yz}, {xz, yz, shape(5)}};
    const Vector arm{load(stretch.arm_m[0], i), load(stretch.arm_m[1], i), load(stretch.arm_m[2], i)};
    add_definite(sum, c, arm, load(stretch.weight[0], i));
  }
  for (int k = 0; k < 21; ++k) sums[k] = sum[k];
}

HWY_INLINE void add_all_outer(std::size_t count, const Stretch& stretch, float d2, V* sums) {
  const Floats d;
  V sum[21];
  for (int k = 0; k < 21; ++k) sum[k] = sums[k];
  for (std::size_t i = 0; i < std::min(kStretch, count); i += hn::Lanes(d)) {
    V u[6];
    for (std::size_t k = 0; k < 6; ++k) u[k] = load(stretch.gradient[k], i);
    add_outer(sum, u, hn::Mul(load(stretch.weight[0], i), hn::Set(d, d2)));
  }
  for (int k = 0; k < 21; ++k) sums[k] = sum[k];
}

HWY_ATTR void sum_pairs_simd(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                             const ScoreConstants& constants, GroupSums& result) {
  const Floats d;
  V sums[kGroupSumCount];
  for (V& sum : sums) sum = hn::Zero(d);
  Stretch stretch;
  for (std::size_t first = 0; first < count; first += kStretch) {
    add_first_order(columns, first, count, place, constants, sums, stretch);
    add_all_definite(columns, first, count, stretch, sums + 8);
    add_all_outer(count - first, stretch, static_cast<float>(constants.d2), sums + 29);
  }
  float totals[kGroupSumCount];
  for (std::size_t k = 0; k < kGroupSumCount; ++k) totals[k] = hn::GetLane(hn::SumOfLanes(d, sums[k]));
  std::memcpy(&result, totals, sizeof(result));
}

}  // namespace HWY_NAMESPACE
}  // namespace landfix::ndt
HWY_AFTER_NAMESPACE();
// NOLINTEND(modernize-concat-nested-namespaces)

#if HWY_ONCE
namespace landfix::ndt {

HWY_EXPORT(sum_pairs_simd);
HWY_EXPORT(score_pairs_simd);

GroupSums sum_pairs(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                    const ScoreConstants& constants) noexcept {
  GroupSums sums;
  HWY_DYNAMIC_DISPATCH(sum_pairs_simd)(columns, count, place, constants, sums);
  return sums;
}

void score_pairs(const PairColumns& columns, std::size_t count, const GroupPlace& place,
                 const ScoreConstants& constants, std::span<float, kGroupPairs> scores) noexcept {
  HWY_DYNAMIC_DISPATCH(score_pairs_simd)(columns, count, place, constants, scores.data());
}

}  // namespace landfix::ndt
#endif
