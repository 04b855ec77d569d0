// Poses to send, anywhere in what the frames can hold.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <variant>

#include "platform/pose_frame_table.hpp"

namespace landfix::test {

/// Every value of the layouts' signals uniform over its range; where two layouts share one, over the last's.
[[nodiscard]] inline platform::PoseReport random_report(std::mt19937_64& random,
                                                        std::span<const platform::FrameLayout> layouts) {
  platform::PoseReport report;
  for (const platform::FrameLayout& layout : layouts) {
    for (const platform::Signal& signal : layout.signals) {
      if (const auto* number = std::get_if<double platform::PoseReport::*>(&signal.field)) {
        const double low = static_cast<double>(signal.lowest()) * signal.scale;
        const double high = static_cast<double>(signal.highest()) * signal.scale;
        report.** number = std::uniform_real_distribution<double>(low, high)(random);
      } else if (const auto* code = std::get_if<std::uint16_t platform::PoseReport::*>(&signal.field)) {
        report.** code = static_cast<std::uint16_t>(random() & signal.highest());
      }
    }
  }
  report.stamp_utc_ns = static_cast<std::int64_t>(random() % 2'000'000'000'000'000'000U);
  report.saturated = 0;
  report.weak = report.weak_axes != 0 ? 1 : 0;
  return report;
}

}  // namespace landfix::test
