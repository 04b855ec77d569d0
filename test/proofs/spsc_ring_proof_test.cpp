#include <gtest/gtest.h>

#include "platform/spsc_ring.hpp"
#include "proofs/modelled.hpp"

namespace landfix::platform {
namespace {

/// Three values through two slots, so that a slot is used again.
template <class Orders>
struct ThreeValuesPass : rl::test_suite<ThreeValuesPass<Orders>, 2> {
  static constexpr int kValues = 3;
  SpscRing<ModelledValue, 2, SpscIndices<Orders, ModelledAtomic>> ring;

  void thread(unsigned index) {
    rl::linear_backoff wait;
    if (index == 0) {
      for (int i = 0; i < kValues; ++i) {
        while (!ring.push(ModelledValue(i))) wait.yield($);
      }
    } else {
      for (int i = 0; i < kValues; ++i) {
        ModelledValue value;
        while (!ring.pop(value)) wait.yield($);
        RL_ASSERT(value.get() == i);
      }
    }
  }
};

struct PublishesRelaxed : SpscOrders {
  static constexpr std::memory_order kPublish = std::memory_order_relaxed;
};
struct SeesPublishedRelaxed : SpscOrders {
  static constexpr std::memory_order kSeePublished = std::memory_order_relaxed;
};
struct FreesRelaxed : SpscOrders {
  static constexpr std::memory_order kFree = std::memory_order_relaxed;
};
struct SeesFreedRelaxed : SpscOrders {
  static constexpr std::memory_order kSeeFreed = std::memory_order_relaxed;
};

TEST(SpscRingProof, HoldsInEveryInterleaving) { EXPECT_TRUE(holds<ThreeValuesPass<SpscOrders>>()); }

TEST(SpscRingProof, NeedsEachOfItsOrders) {
  EXPECT_TRUE(is_broken<ThreeValuesPass<PublishesRelaxed>>());
  EXPECT_TRUE(is_broken<ThreeValuesPass<SeesPublishedRelaxed>>());
  EXPECT_TRUE(is_broken<ThreeValuesPass<FreesRelaxed>>());
  EXPECT_TRUE(is_broken<ThreeValuesPass<SeesFreedRelaxed>>());
}

}  // namespace
}  // namespace landfix::platform
