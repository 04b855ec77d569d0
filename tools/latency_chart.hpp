// Latencies of the stages above one another, on one logarithmic axis.
#pragma once

#include <span>
#include <string>

#include "platform/hgrm.hpp"

namespace landfix::tools {

/// An SVG: how often each duration occurred, with marks at p50, p99 and the maximum. Stages without values
/// are left out; empty if all are.
[[nodiscard]] std::string latency_chart_svg(std::span<const platform::LatencyDistribution> stages);

}  // namespace landfix::tools
