// Latencies stage by stage, and whether they are within their budget.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "platform/hgrm.hpp"

namespace landfix::tools {

/// What is told of a stage, and what a budget may limit.
inline constexpr std::array<std::string_view, 5> kLatencyKeys{"p50_ms", "p90_ms", "p99_ms", "p999_ms",
                                                              "max_ms"};
/// One for each of kLatencyKeys; NaN: none.
using LatencyValues = std::array<double, kLatencyKeys.size()>;

struct StageLatency {
  std::string stage;
  std::uint64_t count = 0;
  LatencyValues values_ms{};
};
[[nodiscard]] StageLatency latency_of(const platform::LatencyDistribution& distribution);

/// Limits by stage.
using LatencyBudget = std::map<std::string, LatencyValues, std::less<>>;

/// What landfix aims at on an idle core: a pose within 1 ms of its sweep's last packet, 2 ms at most.
[[nodiscard]] LatencyBudget default_budget();
/// TOML: a section a stage, its keys of kLatencyKeys. Throws std::runtime_error with line and column.
[[nodiscard]] LatencyBudget parse_budget(std::string_view text, const std::filesystem::path& path);
[[nodiscard]] LatencyBudget read_budget(const std::filesystem::path& path);

[[nodiscard]] std::string to_table(std::span<const StageLatency> stages, const LatencyBudget& budget);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const StageLatency> stages,
                                             const LatencyBudget& budget);

}  // namespace landfix::tools
