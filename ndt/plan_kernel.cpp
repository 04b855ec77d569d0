#include "ndt/plan_kernel.hpp"

#include <algorithm>

#include "ndt/simd_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ndt/plan_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// NOLINTBEGIN(modernize-concat-nested-namespaces): Highway compiles this part once an instruction set.
HWY_BEFORE_NAMESPACE();
namespace landfix::ndt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
HWY_ATTR void score_nodes_simd(const std::uint8_t* first, std::span<const std::int32_t> offsets,
                               NodeScores& scores) {
  scores.fill(0);
  for (const std::int32_t offset : offsets) {
    for (std::size_t node = 0; node < kNodesTogether; ++node)
      scores[node] += first[offset + static_cast<std::ptrdiff_t>(node)];
  }
}
#else
/// Weights of 4 bits: so many fit a byte.
constexpr std::size_t kBatch = 16;

HWY_ATTR void score_nodes_simd(const std::uint8_t* first, std::span<const std::int32_t> offsets,
                               NodeScores& scores) {
  const hn::CappedTag<std::uint8_t, kNodesTogether> bytes;
  const hn::Half<decltype(bytes)> half_bytes;
  const hn::Repartition<std::uint16_t, decltype(bytes)> words;
  for (std::size_t node = 0; node < kNodesTogether; node += hn::Lanes(bytes)) {
    auto low = hn::Zero(words);
    auto high = hn::Zero(words);
    for (std::size_t begin = 0; begin < offsets.size(); begin += kBatch) {
      auto batch = hn::Zero(bytes);
      for (const std::int32_t offset : offsets.subspan(begin, std::min(kBatch, offsets.size() - begin))) {
        batch = hn::Add(batch, hn::LoadU(bytes, first + offset + node));
      }
      low = hn::Add(low, hn::PromoteTo(words, hn::LowerHalf(half_bytes, batch)));
      high = hn::Add(high, hn::PromoteTo(words, hn::UpperHalf(half_bytes, batch)));
    }
    hn::StoreU(low, words, scores.data() + node);
    hn::StoreU(high, words, scores.data() + node + hn::Lanes(words));
  }
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace landfix::ndt
HWY_AFTER_NAMESPACE();
// NOLINTEND(modernize-concat-nested-namespaces)

#if HWY_ONCE
namespace landfix::ndt {

HWY_EXPORT(score_nodes_simd);

void score_nodes(const std::uint8_t* first, std::span<const std::int32_t> offsets,
                 NodeScores& scores) noexcept {
  HWY_DYNAMIC_DISPATCH(score_nodes_simd)(first, offsets, scores);
}

}  // namespace landfix::ndt
#endif
