// Reads the keys of one TOML section into variables, each with a check; what was not asked for is an error.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "ndt/pose.hpp"
#include "ndt/pose_guess.hpp"

namespace landfix::platform {

/// Both ends belong to it.
template <class Number>
struct Range {
  Number low;
  Number high;
};

/// A missing key leaves its variable as it is. Everything throws std::runtime_error with file, line and
/// column.
class TomlSection {
 public:
  TomlSection(const std::filesystem::path& file, const toml::table& root, std::string_view name);

  void read(std::string_view key, bool& value);
  void read(std::string_view key, double& value, Range<double> range);
  /// An empty file name stays empty, a relative one starts from the configuration's folder.
  void read(std::string_view key, std::filesystem::path& value);
  /// [x, y, z], metres.
  void read(std::string_view key, Eigen::Vector3d& value);
  /// [x, y, z, roll_deg, pitch_deg, yaw_deg], metres and degrees.
  void read(std::string_view key, ndt::Pose& value);
  void read(std::string_view key, std::optional<ndt::Pose>& value);
  /// [x, y, radius], metres.
  void read(std::string_view key, std::optional<ndt::PoseGuess>& value);
  /// A list of whole numbers from 0 on, four at most.
  void read(std::string_view key, std::array<std::uint64_t, 4>& values, std::size_t& count);
  /// The tables of [[NAME.KEY]], which `name` calls by their full name.
  [[nodiscard]] std::vector<TomlSection> tables(std::string_view key, std::string_view name);

  template <class Integer>
  void read(std::string_view key, Integer& value, Range<Integer> range) {
    value = static_cast<Integer>(integer(key, value, {range.low, range.high}));
  }

  /// `allowed` completes the sentence "expected ..." for what `accepts` refuses.
  template <class Accepts>
  void read(std::string_view key, std::string& value, Accepts accepts, std::string_view allowed) {
    const toml::node* const node = find(key);
    if (node == nullptr) return;
    const auto text = node->value_exact<std::string>();
    if (!text || !accepts(std::string_view(*text))) fail(key, *node, allowed);
    value = *text;
  }

  /// Throws if the section lacks the key.
  void require(std::string_view key) const;
  /// Throws if the section holds a key that was not read.
  void finish() const;
  /// "file:line:column: section.key = value; expected ...", where `key` stands.
  [[noreturn]] void fail(std::string_view key, std::string_view expected) const;

 private:
  TomlSection(const std::filesystem::path& file, std::string_view name, const toml::table& table)
      : file_(file), name_(name), table_(&table) {}

  [[nodiscard]] const toml::node* find(std::string_view key);
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t value, Range<std::int64_t> range);
  [[noreturn]] void fail(std::string_view key, const toml::node& node, std::string_view expected) const;

  const std::filesystem::path& file_;
  std::string_view name_;
  const toml::table* table_ = nullptr;
  std::vector<std::string_view> known_keys_;
};

/// "file:line:column"
[[nodiscard]] std::string place(const std::filesystem::path& file, const toml::source_region& region);

}  // namespace landfix::platform
