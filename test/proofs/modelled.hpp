// Atomics and plain memory as Relacy models them, in the shape that the structures of platform/ take.
#pragma once

#include <atomic>
#include <iostream>

#include <relacy/relacy.hpp>

// Relacy's macros of these names stand for its own.
#undef memory_order_relaxed
#undef memory_order_consume
#undef memory_order_acquire
#undef memory_order_release
#undef memory_order_acq_rel
#undef memory_order_seq_cst
#undef new
#undef delete

namespace landfix::platform {

[[nodiscard]] inline rl::memory_order modelled(std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return rl::mo_relaxed;
    case std::memory_order_acquire:
      return rl::mo_acquire;
    case std::memory_order_release:
      return rl::mo_release;
    case std::memory_order_acq_rel:
      return rl::mo_acq_rel;
    default:
      return rl::mo_seq_cst;
  }
}

template <class T>
class ModelledAtomic {
 public:
  ModelledAtomic(T value) : atomic_(value) {}
  [[nodiscard]] T load(std::memory_order order) const { return atomic_.load(modelled(order), $); }
  void store(T value, std::memory_order order) { atomic_.store(value, modelled(order), $); }
  T exchange(T value, std::memory_order order) { return atomic_.exchange(value, modelled(order), $); }

 private:
  rl::atomic<T> atomic_;
};

/// Plain memory: a read and a write of it that nothing orders are a data race, which ends the search.
class ModelledValue {
 public:
  ModelledValue() = default;
  explicit ModelledValue(int value) { value_($) = value; }
  ModelledValue(const ModelledValue& other) { value_($) = static_cast<int>(other.value_($)); }
  ModelledValue& operator=(const ModelledValue& other) {
    value_($) = static_cast<int>(other.value_($));
    return *this;
  }
  [[nodiscard]] int get() const { return value_($); }

 private:
  mutable rl::var<int> value_;
};

/// Whether no interleaving of the suite's threads, up to 4 changes of thread against its will, breaks it. The
/// story of one that does goes to `story`, which must not allocate.
template <class Suite>
[[nodiscard]] bool holds(std::ostream& story = std::cout) {
  rl::test_params params;
  params.search_type = rl::sched_bound;
  params.context_bound = 4;
  params.execution_depth_limit = 2000;
  params.progress_stream = &story;
  params.output_stream = &story;
  return rl::simulate<Suite>(params);
}

/// For what must not hold.
template <class Suite>
[[nodiscard]] bool is_broken() {
  std::ostream nowhere(nullptr);
  return !holds<Suite>(nowhere);
}

}  // namespace landfix::platform
