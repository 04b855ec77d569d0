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

/// The keys of blocks, as they lie in memory on a little-endian machine: the low half first.
HWY_ATTR void store_keys(W x, W y, W z, std::uint64_t* keys) {
  static_assert(kBlockBits == 17 && kPlaceBits == 14, "as the shifts have it");
  const Words d;
  const W high = hn::Or(hn::And(x, hn::Set(d, 0xFFFF8000U)), hn::ShiftRight<17>(y));
  const W low = hn::Or(hn::And(hn::ShiftLeft<15>(y), hn::Set(d, 0xC0000000U)),
                       hn::And(hn::ShiftRight<2>(z), hn::Set(d, 0x3FFFE000U)));
  hn::StoreInterleaved2(low, high, d, reinterpret_cast<std::uint32_t*>(keys));
}

/// Blocks of a row along x lie side by side, rows anywhere.
HWY_ATTR W hash_of_block(W x, W y, W z) {
  const Words d;
  const W row = hn::Add(hn::Mul(hn::ShiftRight<15>(y), hn::Set(d, 0x85EBCA77U)),
                        hn::Mul(hn::ShiftRight<15>(z), hn::Set(d, 0xC2B2AE3DU)));
  return hn::Add(hn::ShiftRight<15>(x), row);
}

HWY_ATTR W cell_in_block(W x, W y, W z) {
  const W odd = hn::Set(Words(), 1U << 14);
  return hn::Or(hn::ShiftRight<12>(hn::And(x, odd)),
                hn::Or(hn::ShiftRight<13>(hn::And(y, odd)), hn::ShiftRight<14>(hn::And(z, odd))));
}

HWY_ATTR bool find_cells_simd(const float* points_m, float inverse_leaf_1pm, CellBatch& batch) {
  const Floats d;
  const Words dw;
  constexpr float kOneCell = 1 << kPlaceBits;
  const auto scale = hn::Set(d, inverse_leaf_1pm * kOneCell);
  const auto limit = hn::Set(d, kMostCells * kOneCell);
  auto all_inside = hn::Eq(limit, limit);
  const auto to_word = [&](hn::Vec<Floats> position_m) HWY_ATTR {
    const auto scaled = hn::Mul(position_m, scale);
    all_inside = hn::And(all_inside, hn::Lt(hn::Abs(scaled), limit));
    // Turning the sign bit adds the bias.
    return hn::Xor(hn::BitCast(dw, hn::NearestInt(scaled)), hn::Set(dw, 0x80000000U));
  };
  for (std::size_t n = 0; n < kCellBatch; n += hn::Lanes(d)) {
    hn::Vec<Floats> x_m;
    hn::Vec<Floats> y_m;
    hn::Vec<Floats> z_m;
    hn::LoadInterleaved3(d, points_m + 3 * n, x_m, y_m, z_m);
    const W x = to_word(x_m);
    const W y = to_word(y_m);
    const W z = to_word(z_m);
    hn::StoreInterleaved4(x, y, z, hn::Set(dw, 1U), dw, batch.point[n].data());
    store_keys(x, y, z, batch.block.data() + n);
    hn::Store(hash_of_block(x, y, z), dw, batch.hash.data() + n);
    hn::Store(cell_in_block(x, y, z), dw, batch.cell.data() + n);
  }
  return hn::AllTrue(d, all_inside);
}

}  // namespace HWY_NAMESPACE
}  // namespace landfix::ndt
HWY_AFTER_NAMESPACE();
// NOLINTEND(modernize-concat-nested-namespaces)

#if HWY_ONCE
namespace landfix::ndt {

HWY_EXPORT(find_cells_simd);

bool find_cells(std::span<const Eigen::Vector3f, kCellBatch> points_m, float inverse_leaf_1pm,
                CellBatch& batch) noexcept {
  return HWY_DYNAMIC_DISPATCH(find_cells_simd)(points_m.data()->data(), inverse_leaf_1pm, batch);
}

}  // namespace landfix::ndt
#endif
