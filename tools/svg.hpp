// What the pictures share: text that grows by formatted lines, and round numbers for their axes.
#pragma once

#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace landfix::tools {

class Svg {
 public:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    text_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// 1, 2 or 5 times a power of ten: the largest that is not above `value`, which is positive.
[[nodiscard]] inline double nice_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= value) return step * power;
  }
  return power;
}

/// Likewise the smallest that is not below.
[[nodiscard]] inline double nice_above(double value) {
  const double below = nice_below(value);
  if (below >= value) return below;
  return nice_below(below * 2.6);  // 1 -> 2, 2 -> 5, 5 -> 10
}

}  // namespace landfix::tools
