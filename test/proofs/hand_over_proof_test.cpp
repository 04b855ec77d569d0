#include <array>

#include <gtest/gtest.h>

#include "platform/hand_over.hpp"
#include "proofs/modelled.hpp"

namespace landfix::platform {
namespace {

/// The reader keeps reading its buffer while the writer fills the other.
template <class Orders>
struct BuffersPass : rl::test_suite<BuffersPass<Orders>, 2> {
  static constexpr int kTurns = 4;
  HandOverOf<Orders, ModelledAtomic> hand_over;
  std::array<ModelledValue, 2> buffers;

  void before() { buffers[1] = ModelledValue(0); }
  void thread(unsigned index) {
    int last = 0;
    for (int i = 1; i <= kTurns; ++i) {
      if (index == 0) {
        const auto buffer = hand_over.writable();
        if (!buffer) continue;
        buffers[*buffer] = ModelledValue(i);
        hand_over.publish();
      } else {
        const int seen = buffers[hand_over.newest()].get();
        RL_ASSERT(seen >= last);
        last = seen;
      }
    }
  }
};

struct PublishesRelaxed : HandOverOrders {
  static constexpr std::memory_order kPublish = std::memory_order_relaxed;
};
struct SeesPublishedRelaxed : HandOverOrders {
  static constexpr std::memory_order kSeePublished = std::memory_order_relaxed;
};
struct TakesRelaxed : HandOverOrders {
  static constexpr std::memory_order kTake = std::memory_order_relaxed;
};
struct SeesTakenRelaxed : HandOverOrders {
  static constexpr std::memory_order kSeeTaken = std::memory_order_relaxed;
};

TEST(HandOverProof, HoldsInEveryInterleaving) { EXPECT_TRUE(holds<BuffersPass<HandOverOrders>>()); }

TEST(HandOverProof, NeedsEachOfItsOrders) {
  EXPECT_TRUE(is_broken<BuffersPass<PublishesRelaxed>>());
  EXPECT_TRUE(is_broken<BuffersPass<SeesPublishedRelaxed>>());
  EXPECT_TRUE(is_broken<BuffersPass<TakesRelaxed>>());
  EXPECT_TRUE(is_broken<BuffersPass<SeesTakenRelaxed>>());
}

}  // namespace
}  // namespace landfix::platform
