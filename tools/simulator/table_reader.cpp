#include "tools/simulator/table_reader.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace landfix::tools::simulator {

double TableReader::number(std::string_view key, double fallback, Range range) {
  const toml::node* const node = find(key);
  if (node == nullptr) return fallback;
  const auto value = node->value<double>();
  if (!value || !(*value >= range.low && *value <= range.high)) {
    fail(node->source(), fmt::format("{} must be a number from {} to {}", key, range.low, range.high));
  }
  return *value;
}

double TableReader::number(std::string_view key, Range range) {
  require(key);
  return number(key, 0.0, range);
}

std::int64_t TableReader::integer(std::string_view key, std::int64_t fallback, std::int64_t low,
                                  std::int64_t high) {
  const toml::node* const node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_integer() || node->ref<std::int64_t>() < low || node->ref<std::int64_t>() > high) {
    fail(node->source(), fmt::format("{} must be a whole number from {} to {}", key, low, high));
  }
  return node->ref<std::int64_t>();
}

TableReader TableReader::table(std::string_view key) {
  require(key);
  return *optional_table(key);
}

std::optional<TableReader> TableReader::optional_table(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail(node->source(), fmt::format("{} must be a table", key));
  return TableReader(*node->as_table(), file_);
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
  require(key);
  const toml::node* const node = find(key);
  if (!node->is_array_of_tables()) fail(node->source(), fmt::format("write {0} as [[{0}]] tables", key));
  std::vector<TableReader> readers;
  for (const toml::node& entry : *node->as_array()) readers.emplace_back(*entry.as_table(), file_);
  return readers;
}

void TableReader::refuse_unknown_keys() const {
  for (const auto& [key, node] : table_) {
    if (!known_.contains(std::string(key.str()))) {
      fail(key.source(), fmt::format("unknown key '{}'; known here: {}", key.str(), fmt::join(known_, ", ")));
    }
  }
}

void TableReader::fail(std::string_view key, const std::string& message) const {
  fail(table_.get(key)->source(), message);
}

const toml::node* TableReader::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

void TableReader::require(std::string_view key) const {
  if (!has(key)) fail(fmt::format("'{}' is missing here", key));
}

void TableReader::fail(const toml::source_region& where, const std::string& message) const {
  throw std::runtime_error(fmt::format("{}:{}:{}: {}", file_, where.begin.line, where.begin.column, message));
}

}  // namespace landfix::tools::simulator
