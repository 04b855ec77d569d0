#include "tools/latency_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include "platform/atomic_file.hpp"
#include "platform/stage.hpp"
#include "platform/toml_section.hpp"

namespace landfix::tools {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, kLatencyKeys.size() - 1> kPercents{50.0, 90.0, 99.0, 99.9};

enum class BudgetVerdict : std::uint8_t { none, met, missed };

/// "p50 < 1, p99.9 < 2", and whether it is so.
struct Judgement {
  std::string budget;
  BudgetVerdict verdict = BudgetVerdict::none;
};

[[nodiscard]] const LatencyValues* limits_of(std::string_view stage, const LatencyBudget& budget) {
  const auto found = budget.find(stage);
  return found == budget.end() ? nullptr : &found->second;
}

[[nodiscard]] Judgement judge(const StageLatency& stage, const LatencyBudget& budget) {
  constexpr std::array<std::string_view, kLatencyKeys.size()> kNames{"p50", "p90", "p99", "p99.9", "max"};
  Judgement judgement;
  const LatencyValues* const limits_ms = limits_of(stage.stage, budget);
  if (limits_ms == nullptr || stage.count == 0) return judgement;
  for (std::size_t i = 0; i < kLatencyKeys.size(); ++i) {
    const double limit_ms = (*limits_ms)[i];
    if (std::isnan(limit_ms)) continue;
    judgement.budget += fmt::format("{}{} {:g}", judgement.budget.empty() ? "" : ", ", kNames[i], limit_ms);
    if (judgement.verdict != BudgetVerdict::missed) {
      judgement.verdict = stage.values_ms[i] <= limit_ms ? BudgetVerdict::met : BudgetVerdict::missed;
    }
  }
  return judgement;
}

[[nodiscard]] std::string_view to_string(BudgetVerdict verdict) {
  constexpr std::array<std::string_view, 3> kNames{"-", "MET", "MISSED"};
  return kNames[static_cast<std::size_t>(verdict)];
}

[[nodiscard]] std::string cell_ms(double value_ms) {
  return std::isnan(value_ms) ? "-" : fmt::format("{:.4f}", value_ms);
}

}  // namespace

StageLatency latency_of(const platform::LatencyDistribution& distribution) {
  StageLatency latency{.stage = distribution.stage, .count = distribution.count(), .values_ms = {}};
  latency.values_ms.fill(kNothing);
  if (latency.count == 0) return latency;
  for (std::size_t i = 0; i < kPercents.size(); ++i) {
    latency.values_ms[i] = distribution.percentile_ms(kPercents[i]);
  }
  latency.values_ms.back() = distribution.max_ms;
  return latency;
}

LatencyBudget default_budget() {
  return {{"kernel_receive", {kNothing, kNothing, 0.1, kNothing, kNothing}},
          {"publish", {kNothing, kNothing, 0.2, kNothing, kNothing}},
          {"last_packet", {1.0, kNothing, kNothing, 2.0, kNothing}},
          {"total", {1.0, kNothing, kNothing, 2.0, kNothing}}};
}

LatencyBudget parse_budget(std::string_view text, const std::filesystem::path& path) {
  toml::table root;
  try {
    root = toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(
        fmt::format("{}: {}", platform::place(path, error.source()), error.description()));
  }
  LatencyBudget budget;
  for (const auto& [key, node] : root) {
    const std::string_view stage = key.str();
    if (std::ranges::find(platform::kStageNames, stage) == platform::kStageNames.end()) {
      throw std::runtime_error(fmt::format("{}: no stage {}; there are {}",
                                           platform::place(path, key.source()), stage,
                                           fmt::join(platform::kStageNames, ", ")));
    }
    LatencyValues& limits_ms = budget[std::string(stage)];
    limits_ms.fill(kNothing);
    platform::TomlSection section(path, root, stage);
    for (std::size_t i = 0; i < kLatencyKeys.size(); ++i) {
      section.read(kLatencyKeys[i], limits_ms[i], {1e-6, 1e6});
    }
    section.finish();
  }
  return budget;
}

LatencyBudget read_budget(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = platform::read_file(path);
  return parse_budget({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

std::string to_table(std::span<const StageLatency> stages, const LatencyBudget& budget) {
  std::string text;
  const auto add = [&text]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
    text += fmt::format(format, std::forward<Values>(values)...);
  };
  add("{:<14} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  {:<6} {}\n", "stage [ms]", "p50", "p90", "p99", "p99.9",
      "max", "count", "", "budget");
  for (const StageLatency& stage : stages) {
    const Judgement judgement = judge(stage, budget);
    add("{:<14} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  {:<6} {}\n", stage.stage, cell_ms(stage.values_ms[0]),
        cell_ms(stage.values_ms[1]), cell_ms(stage.values_ms[2]), cell_ms(stage.values_ms[3]),
        cell_ms(stage.values_ms[4]), stage.count, to_string(judgement.verdict), judgement.budget);
  }
  return text;
}

nlohmann::ordered_json to_json(std::span<const StageLatency> stages, const LatencyBudget& budget) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const StageLatency& stage : stages) {
    nlohmann::ordered_json entry{{"count", stage.count}};
    for (std::size_t i = 0; i < kLatencyKeys.size(); ++i) {
      entry[std::string(kLatencyKeys[i])] = stage.values_ms[i];
    }
    const Judgement judgement = judge(stage, budget);
    entry["met"] = nullptr;
    if (judgement.verdict != BudgetVerdict::none) entry["met"] = judgement.verdict == BudgetVerdict::met;
    if (const LatencyValues* const limits_ms = limits_of(stage.stage, budget)) {
      nlohmann::ordered_json limits;
      for (std::size_t i = 0; i < kLatencyKeys.size(); ++i) {
        if (!std::isnan((*limits_ms)[i])) limits[std::string(kLatencyKeys[i])] = (*limits_ms)[i];
      }
      entry["budget"] = limits;
    }
    object[stage.stage] = entry;
  }
  return {{"stages", object}};
}

}  // namespace landfix::tools
