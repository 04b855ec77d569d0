// A stream of values from one thread to one other, in order, without a lock. Where it is full the arriving
// value is refused, and whoever pushed it counts that.
#pragma once

#include <array>
#include <bit>
#include <cstddef>

#include "platform/spsc_indices.hpp"

namespace landfix::platform {

template <class T, std::size_t kCapacity, class Indices = SpscIndices<>>
class SpscRing {
 public:
  static_assert(std::has_single_bit(kCapacity), "slots are found by masking");

  /// For the producer. False if it is full.
  [[nodiscard]] bool push(const T& value) noexcept {
    if (indices_.writable(1) == 0) return false;
    slots_[indices_.write_slot(0)] = value;
    indices_.publish(1);
    return true;
  }

  /// For the consumer. False if it is empty.
  [[nodiscard]] bool pop(T& value) noexcept {
    if (indices_.readable(1) == 0) return false;
    value = slots_[indices_.read_slot(0)];
    indices_.free(1);
    return true;
  }

 private:
  Indices indices_{kCapacity};
  std::array<T, kCapacity> slots_{};
};

}  // namespace landfix::platform
