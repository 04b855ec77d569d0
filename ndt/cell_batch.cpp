#include "ndt/cell_batch.hpp"

#include "ndt/simd_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ndt/cell_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// NOLINTBEGIN(modernize-concat-nested-namespaces): Highway compiles this part once an instruction set.
HWY_BEFORE_NAMESPACE();
namespace landfix::ndt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Most of the work is shuffling, which wider vectors are slower at.
using Floats = hn::CappedTag<float, 8>;
using Words = hn::RebindToUnsigned<Floats>;
using W = hn::Vec<Words>;

/// Added to a whole number below 2^23, it leaves that number in the lowest bits.
constexpr std::uint32_t kMagicBits = 0x4B000000;
constexpr float kMagic = 1 << 23;

/// Coordinates along one axis.
struct Split {
  W index;  ///< of the cell, and kMagicBits
  W place;  ///< in it, and kMagicBits
};

HWY_ATTR Split split(hn::Vec<Floats> position_m, float inverse_leaf_1pm) {
  const Floats d;
  const Words dw;
  const auto cells = hn::Mul(position_m, hn::Set(d, inverse_leaf_1pm));
  const auto lower = hn::Floor(cells);
  const auto index = hn::Add(lower, hn::Set(d, kMagic + kIndexBias));
  // Fused or not, it is the same: the product is exact.
  const auto place = hn::MulAdd(hn::Sub(cells, lower), hn::Set(d, 1 << kPlaceBits), hn::Set(d, kMagic));
  return {hn::BitCast(dw, index), hn::BitCast(dw, place)};
}

/// The keys of blocks, as they lie in memory on a little-endian machine: the low half first.
HWY_ATTR void store_keys(W x, W y, W z, std::uint64_t* keys) {
  static_assert(kBlockBits == 17, "as the shifts have it");
  const Words d;
  const W high = hn::Or(hn::ShiftLeft<15>(x), hn::And(hn::ShiftRight<2>(y), hn::Set(d, 0x7FFFU)));
  const W low = hn::Or(hn::ShiftLeft<30>(y), hn::And(hn::ShiftLeft<13>(z), hn::Set(d, 0x3FFFE000U)));
  hn::StoreInterleaved2(low, high, d, reinterpret_cast<std::uint32_t*>(keys));
}

/// Blocks of a row along x lie side by side, rows anywhere.
HWY_ATTR W hash_of_block(W x, W y, W z) {
  const Words d;
  const W row = hn::Add(hn::Mul(y, hn::Set(d, 0x85EBCA77U)), hn::Mul(z, hn::Set(d, 0xC2B2AE3DU)));
  return hn::Add(x, row);
}

HWY_ATTR W cell_in_block(W x, W y, W z) {
  const W odd = hn::Set(Words(), 1U);
  return hn::Or(hn::ShiftLeft<2>(hn::And(x, odd)),
                hn::Or(hn::ShiftLeft<1>(hn::And(y, odd)), hn::And(z, odd)));
}

/// Four halves of words a point, as they lie in memory: the lower first.
HWY_ATTR void store_places(W x, W y, W z, Place* places) {
  const Words d;
  const W x_y = hn::Xor(hn::Xor(x, hn::Set(d, kMagicBits)), hn::ShiftLeft<16>(y));
  const W z_one = hn::Xor(z, hn::Set(d, kMagicBits ^ 1U << 16));
  hn::StoreInterleaved2(x_y, z_one, d, reinterpret_cast<std::uint32_t*>(places));
}

HWY_ATTR bool find_cells_simd(const float* points_m, float inverse_leaf_1pm, std::uint32_t slot_mask,
                              CellBatch& batch) {
  const Floats d;
  const Words dw;
  const W mask = hn::Set(dw, slot_mask);
  W strange = hn::Zero(dw);  // bits that no index has
  for (std::size_t n = 0; n < kCellBatch; n += hn::Lanes(d)) {
    hn::Vec<Floats> x_m;
    hn::Vec<Floats> y_m;
    hn::Vec<Floats> z_m;
    hn::LoadInterleaved3(d, points_m + 3 * n, x_m, y_m, z_m);
    const Split x = split(x_m, inverse_leaf_1pm);
    const Split y = split(y_m, inverse_leaf_1pm);
    const Split z = split(z_m, inverse_leaf_1pm);
    for (const W index : {x.index, y.index, z.index}) {
      strange = hn::Or(strange, hn::Xor(index, hn::Set(dw, kMagicBits)));
    }
    const W block_x = hn::ShiftRight<1>(x.index);
    const W block_y = hn::ShiftRight<1>(y.index);
    const W block_z = hn::ShiftRight<1>(z.index);
    store_keys(block_x, block_y, block_z, batch.key.data() + n);
    hn::Store(hn::And(hash_of_block(block_x, block_y, block_z), mask), dw, batch.slot.data() + n);
    hn::Store(cell_in_block(x.index, y.index, z.index), dw, batch.cell.data() + n);
    store_places(x.place, y.place, z.place, batch.place.data() + n);
  }
  return hn::AllTrue(dw, hn::Lt(strange, hn::Set(dw, 2U * kIndexBias)));
}

}  // namespace HWY_NAMESPACE
}  // namespace landfix::ndt
HWY_AFTER_NAMESPACE();
// NOLINTEND(modernize-concat-nested-namespaces)

#if HWY_ONCE
namespace landfix::ndt {

HWY_EXPORT(find_cells_simd);

bool find_cells(std::span<const Eigen::Vector3f, kCellBatch> points_m, float inverse_leaf_1pm,
                std::uint32_t slot_mask, CellBatch& batch) noexcept {
  return HWY_DYNAMIC_DISPATCH(find_cells_simd)(points_m.data()->data(), inverse_leaf_1pm, slot_mask, batch);
}

}  // namespace landfix::ndt
#endif
