// The median of the last few numbers: bears an outlier or two, and follows a step in a few.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace landfix::platform {

template <class Number, std::size_t kCount>
class RunningMedian {
 public:
  /// The median with this one; of an even number of them the greater.
  Number add(Number number) noexcept {
    last_[added_++ % kCount] = number;
    auto sorted = last_;
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(added_, kCount));
    const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
    std::nth_element(sorted.begin(), middle, end);
    return *middle;
  }

 private:
  std::array<Number, kCount> last_{};
  std::size_t added_ = 0;
};

}  // namespace landfix::platform
