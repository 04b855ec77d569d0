#include "tools/budget_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace landfix::tools {
namespace {

constexpr double kBytes_per_mib = 1 << 20;

std::string_view policy_of(const platform::ThreadBudget& thread) {
  return thread.priority > 0 ? "FIFO" : "OTHER";
}

}  // namespace

std::string to_text(const platform::Budget& budget) {
  std::string text = fmt::format("{:<8} {:<6} {:>8} {:>5} {:>9} {:>11}  {}\n", "THREAD", "POLICY", "PRIORITY",
                                 "CORE", "STACK/KiB", "DEADLINE/ms", "TASK");
  for (const platform::ThreadBudget& thread : budget.threads) {
    text += fmt::format(
        "{:<8} {:<6} {:>8} {:>5} {:>9} {:>11}  {}\n", thread.name, policy_of(thread), thread.priority,
        thread.core < 0 ? "any" : std::to_string(thread.core), thread.stack_bytes / 1024,
        thread.deadline_ms > 0.0 ? fmt::format("{:.1f}", thread.deadline_ms) : "-", thread.task);
  }
  text += fmt::format("\n{:<24} {:>9}\n", "MEMORY", "MiB");
  for (const platform::MemoryBudget& row : budget.memory) {
    text += fmt::format("{:<24} {:>9.2f}  {}\n", row.name, static_cast<double>(row.bytes) / kBytes_per_mib,
                        row.made_of);
  }
  text +=
      fmt::format("{:<24} {:>9.2f}\n", "sum", static_cast<double>(budget.memory_bytes()) / kBytes_per_mib);
  text += fmt::format("\n{:<24} {:>9}\n", "RATE", "AT MOST");
  for (const platform::RateBudget& row : budget.rates) {
    text += fmt::format("{:<24} {:>9.{}f}  {}\n", row.name, row.value, row.value < 1000.0 ? 1 : 0, row.unit);
  }
  return text;
}

nlohmann::ordered_json to_json(const platform::Budget& budget) {
  nlohmann::ordered_json json{{"threads", nlohmann::ordered_json::array()},
                              {"memory", nlohmann::ordered_json::array()},
                              {"memory_bytes", budget.memory_bytes()},
                              {"rates", nlohmann::ordered_json::array()}};
  for (const platform::ThreadBudget& thread : budget.threads) {
    json["threads"].push_back({{"name", thread.name},
                               {"policy", policy_of(thread)},
                               {"priority", thread.priority},
                               {"core", thread.core},
                               {"stack_bytes", thread.stack_bytes},
                               {"deadline_ms", thread.deadline_ms},
                               {"task", thread.task}});
  }
  for (const platform::MemoryBudget& row : budget.memory) {
    json["memory"].push_back({{"name", row.name}, {"bytes", row.bytes}, {"made_of", row.made_of}});
  }
  for (const platform::RateBudget& row : budget.rates) {
    json["rates"].push_back({{"name", row.name}, {"value", row.value}, {"unit", row.unit}});
  }
  return json;
}

}  // namespace landfix::tools
