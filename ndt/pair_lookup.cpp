#include "ndt/pair_lookup.hpp"

#include <array>
#include <bit>

#include "ndt/simd_targets.hpp"

#ifndef LANDFIX_LANES_IN_FRONT
#define LANDFIX_LANES_IN_FRONT
namespace landfix::ndt {

/// For a mask of 8 lanes the numbers of those that are set, in order, and then nothing.
inline constexpr auto kLanesInFront = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t mask = 0; mask < table.size(); ++mask) {
    std::size_t count = 0;
    for (std::uint8_t lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1U) != 0) table[mask][count++] = lane;
    }
  }
  return table;
}();

}  // namespace landfix::ndt
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ndt/pair_lookup.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// NOLINTBEGIN(modernize-concat-nested-namespaces): Highway compiles this part once an instruction set.
HWY_BEFORE_NAMESPACE();
namespace landfix::ndt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using V = hn::Vec<Floats>;

HWY_ATTR inline std::int32_t floor_of(float value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
}

/// Blocks along one axis that a sphere touches.
struct BlockRange {
  std::int32_t first;
  std::int32_t last;
};

HWY_ATTR inline BlockRange block_range(float position_m, float radius_m, float inverse_resolution_1pm,
                                       std::int32_t origin) {
  return {(origin + floor_of((position_m - radius_m) * inverse_resolution_1pm)) >> 2,
          (origin + floor_of((position_m + radius_m) * inverse_resolution_1pm)) >> 2};
}

/// 0, 1, 2, ...: made on the spot, it would be put together lane by lane.
alignas(64) constexpr std::array<std::uint32_t, 16> kCount{0, 1, 2,  3,  4,  5,  6,  7,
                                                           8, 9, 10, 11, 12, 13, 14, 15};

/// Of one point, in registers: vector stores may alias all that is in memory.
struct Seeker {
  std::array<const float*, 3> mean_m;  ///< columns of the map
  V x_m;
  V y_m;
  V z_m;
  V radius_m2;
};

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_SCALAR
/// Brings the lanes of a mask to the front.
template <class Mask>
struct ToFront {
  HWY_INLINE explicit ToFront(Mask is_near) : wanted(is_near) {}
  template <class D, class Values>
  HWY_INLINE Values operator()(D d, Values values) const {
    return hn::Compress(values, hn::RebindMask(d, wanted));
  }
  Mask wanted;
};
#else
/// Brings the lanes of a mask to the front. Highway 1.0's own way copies its table to the stack each time
/// where the processor has no instruction for it: a match took six times as long.
template <class Mask>
struct ToFront {
  HWY_INLINE explicit ToFront(Mask is_near) {
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(Floats(), is_near, bits.data());
    const hn::RebindToSigned<Floats> di;
    const hn::Rebind<std::uint8_t, decltype(di)> dbytes;
    constexpr auto kLanesMask = static_cast<std::int32_t>(HWY_MAX_BYTES / sizeof(float) - 1);
    order =
        hn::And(hn::PromoteTo(di, hn::LoadU(dbytes, kLanesInFront[bits[0]].data())), hn::Set(di, kLanesMask));
  }
  template <class D, class Values>
  HWY_INLINE Values operator()(D d, Values values) const {
    return hn::TableLookupLanes(values, hn::IndicesFromVec(d, hn::BitCast(hn::RebindToSigned<D>(), order)));
  }
  hn::Vec<hn::RebindToSigned<Floats> > order;
};
#endif

/// Writes the first `count` lanes.
template <class D, class Values>
HWY_INLINE void put(D d, Values values, std::size_t count, hn::TFromD<D>* to) {
  // Whole vectors that are not aligned reach over two lines each, so half of one where that will do.
  const hn::Half<D> half;
  if (count <= hn::Lanes(half)) {
    hn::StoreU(hn::LowerHalf(half, values), half, to);
  } else {
    hn::StoreU(values, d, to);
  }
}

/// Appends the means of a block's voxels that are near the point. `corner_m`: the block's, from the group's
/// origin.
HWY_INLINE void seek_in_block(const Seeker& seeker, const BlockEntry& block,
                              const std::array<float, 3>& corner_m, PairColumns& columns, LookUp& found) {
  const Floats d;
  const hn::RebindToUnsigned<Floats> du;
  const auto count = static_cast<std::size_t>(std::popcount(block.occupancy));
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const std::size_t first = block.first_voxel + i;
    const V x = hn::Add(hn::LoadU(d, seeker.mean_m[0] + first), hn::Set(d, corner_m[0]));
    const V y = hn::Add(hn::LoadU(d, seeker.mean_m[1] + first), hn::Set(d, corner_m[1]));
    const V z = hn::Add(hn::LoadU(d, seeker.mean_m[2] + first), hn::Set(d, corner_m[2]));
    const V dx = hn::Sub(x, seeker.x_m);
    const V dy = hn::Sub(y, seeker.y_m);
    const V dz = hn::Sub(z, seeker.z_m);
    const V distance_m2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const auto is_near = hn::And(hn::Le(distance_m2, seeker.radius_m2), hn::FirstN(d, count - i));
    const std::size_t near = hn::CountTrue(d, is_near);
    const std::size_t n = found.pairs;
    if (n + near > kGroupPairs) {
      found.dropped += near;
      continue;
    }
    const auto index = hn::Add(hn::Load(du, kCount.data()), hn::Set(du, static_cast<std::uint32_t>(first)));
    const ToFront<decltype(is_near)> to_front(is_near);
    put(d, to_front(d, x), near, columns.mean_m[0].data() + n);
    put(d, to_front(d, y), near, columns.mean_m[1].data() + n);
    put(d, to_front(d, z), near, columns.mean_m[2].data() + n);
    put(du, to_front(du, index), near, columns.voxel.data() + n);
    found.pairs += near;
  }
}

/// Writes the point beside each of its pairs, from `first` on.
HWY_INLINE void put_point(const GroupPoints& points, std::size_t point, std::size_t first, std::size_t last,
                          PairColumns& columns) {
  const Floats d;
  const hn::RebindToUnsigned<Floats> du;
  for (std::size_t n = first; n < last; n += hn::Lanes(d)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::StoreU(hn::Set(d, points.point_m[point][axis]), d, columns.point_m[axis].data() + n);
    }
    hn::StoreU(hn::Set(du, static_cast<std::uint32_t>(point)), du, columns.point.data() + n);
  }
}

HWY_ATTR LookUp look_up_pairs_simd(const VoxelMap& map, const GroupPoints& points, PairColumns& columns) {
  const Floats d;
  const auto resolution_m = static_cast<float>(map.resolution_m());
  const float inverse_resolution_1pm = 1.0F / resolution_m;
  const Cell& origin = points.origin;
  LookUp found;
  for (std::size_t point = 0; point < points.count; ++point) {
    const auto& p = points.position_m[point];
    const BlockRange x = block_range(p[0], points.radius_m, inverse_resolution_1pm, origin.i);
    const BlockRange y = block_range(p[1], points.radius_m, inverse_resolution_1pm, origin.j);
    const BlockRange z = block_range(p[2], points.radius_m, inverse_resolution_1pm, origin.k);
    const Seeker seeker{.mean_m = {map.mean_column_m(0), map.mean_column_m(1), map.mean_column_m(2)},
                        .x_m = hn::Set(d, p[0]),
                        .y_m = hn::Set(d, p[1]),
                        .z_m = hn::Set(d, p[2]),
                        .radius_m2 = hn::Set(d, points.radius_m * points.radius_m)};
    const std::size_t first_pair = found.pairs;
    // One loop over the one, two, four or eight of them: a processor foresees its end better than three.
    const unsigned nx = x.last != x.first ? 1 : 0;
    const unsigned ny = y.last != y.first ? 1 : 0;
    const unsigned nz = z.last != z.first ? 1 : 0;
    for (unsigned choice = 0; choice >> (nx + ny + nz) == 0; ++choice) {
      const std::int32_t bi = x.first + static_cast<std::int32_t>(choice & nx);
      const std::int32_t bj = y.first + static_cast<std::int32_t>((choice >> nx) & ny);
      const std::int32_t bk = z.first + static_cast<std::int32_t>(choice >> (nx + ny));
      const BlockEntry* const block = map.find_block(block_key(bi, bj, bk));
      if (block == nullptr) continue;
      seek_in_block(seeker, *block,
                    {static_cast<float>(4 * bi - origin.i) * resolution_m,
                     static_cast<float>(4 * bj - origin.j) * resolution_m,
                     static_cast<float>(4 * bk - origin.k) * resolution_m},
                    columns, found);
    }
    put_point(points, point, first_pair, found.pairs, columns);
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace landfix::ndt
HWY_AFTER_NAMESPACE();
// NOLINTEND(modernize-concat-nested-namespaces)

#if HWY_ONCE
namespace landfix::ndt {

HWY_EXPORT(look_up_pairs_simd);

LookUp look_up_pairs(const VoxelMap& map, const GroupPoints& points, PairColumns& columns) noexcept {
  return HWY_DYNAMIC_DISPATCH(look_up_pairs_simd)(map, points, columns);
}

}  // namespace landfix::ndt
#endif
