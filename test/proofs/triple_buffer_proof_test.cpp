#include <gtest/gtest.h>

#include "platform/triple_buffer.hpp"
#include "proofs/modelled.hpp"

namespace landfix::platform {
namespace {

/// The reader never sees a value that is torn or older than the one before.
template <class Orders>
struct LatestValuePasses : rl::test_suite<LatestValuePasses<Orders>, 2> {
  static constexpr int kValues = 4;
  TripleBuffer<ModelledValue, Orders, ModelledAtomic> buffer;

  void thread(unsigned index) {
    if (index == 0) {
      for (int i = 1; i <= kValues; ++i) {
        buffer.back() = ModelledValue(i);
        buffer.publish();
      }
    } else {
      int last = 0;
      for (int i = 0; i < kValues; ++i) {
        if (!buffer.update()) continue;
        RL_ASSERT(buffer.front().get() > last);
        last = buffer.front().get();
      }
    }
  }
};

template <std::memory_order kOrder>
struct PublishesAs : TripleBufferOrders {
  static constexpr std::memory_order kPublish = kOrder;
};
template <std::memory_order kOrder>
struct TakesAs : TripleBufferOrders {
  static constexpr std::memory_order kTake = kOrder;
};

TEST(TripleBufferProof, HoldsInEveryInterleaving) {
  EXPECT_TRUE(holds<LatestValuePasses<TripleBufferOrders>>());
}

TEST(TripleBufferProof, NeedsEachOfItsOrders) {
  EXPECT_TRUE(is_broken<LatestValuePasses<PublishesAs<std::memory_order_acquire>>>());
  EXPECT_TRUE(is_broken<LatestValuePasses<PublishesAs<std::memory_order_release>>>());
  EXPECT_TRUE(is_broken<LatestValuePasses<TakesAs<std::memory_order_acquire>>>());
  EXPECT_TRUE(is_broken<LatestValuePasses<TakesAs<std::memory_order_release>>>());
}

}  // namespace
}  // namespace landfix::platform
