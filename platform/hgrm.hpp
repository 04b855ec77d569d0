// Latencies as HdrHistogram's text format of percentiles says them (.hgrm), which its plotters read: a line
// for each value that occurs, in milliseconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "platform/latency_histogram.hpp"

namespace landfix::platform {

struct LatencyDistribution {
  struct Step {
    double value_ms = 0.0;
    std::uint64_t count = 0;  ///< of values that do not exceed it
  };

  std::string stage;        ///< what was measured; empty: the file does not say
  std::vector<Step> steps;  ///< both numbers rise
  double mean_ms = 0.0;
  double deviation_ms = 0.0;
  double max_ms = 0.0;

  [[nodiscard]] std::uint64_t count() const { return steps.empty() ? 0 : steps.back().count; }
  /// The smallest value that `percent` of the values do not exceed; NaN if there are none.
  [[nodiscard]] double percentile_ms(double percent) const;
};

[[nodiscard]] LatencyDistribution distribution_of(const LatencyHistogram& histogram, std::string_view stage);

/// HdrHistogram itself writes a line for some percentiles; this writes every value, so that what is read back
/// is what was measured. The name of the stage is one more line of the footer, a comment to other readers.
[[nodiscard]] std::string to_hgrm(const LatencyDistribution& distribution);

/// Of any program that writes the format. Throws std::runtime_error with `name` and the line.
[[nodiscard]] LatencyDistribution parse_hgrm(std::string_view text, std::string_view name);
[[nodiscard]] LatencyDistribution read_hgrm(const std::filesystem::path& path);

/// OUT.STAGE.hgrm of OUT.hgrm.
[[nodiscard]] std::filesystem::path hgrm_of_stage(const std::filesystem::path& path, std::string_view stage);

}  // namespace landfix::platform
