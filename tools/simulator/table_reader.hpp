// Reads the keys of one TOML table, each with its range; what nobody asked for is an error.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace landfix::tools::simulator {

/// Both ends belong to it.
struct Range {
  double low;
  double high;
};

/// The table must outlive its readers. Everything throws std::runtime_error with file, line and column.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string file) : table_(table), file_(std::move(file)) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }

  [[nodiscard]] double number(std::string_view key, double fallback, Range range);
  [[nodiscard]] double number(std::string_view key, Range range);
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t fallback, std::int64_t low,
                                     std::int64_t high);
  [[nodiscard]] TableReader table(std::string_view key);
  [[nodiscard]] std::optional<TableReader> optional_table(std::string_view key);
  [[nodiscard]] std::vector<TableReader> tables(std::string_view key);

  void refuse_unknown_keys() const;
  [[noreturn]] void fail(const std::string& message) const { fail(table_.source(), message); }
  /// Where `key`, which must be there, stands.
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;

 private:
  [[nodiscard]] const toml::node* find(std::string_view key);
  void require(std::string_view key) const;
  [[noreturn]] void fail(const toml::source_region& where, const std::string& message) const;

  const toml::table& table_;
  std::string file_;
  std::set<std::string> known_;
};

}  // namespace landfix::tools::simulator
