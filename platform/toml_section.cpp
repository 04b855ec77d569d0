#include "platform/toml_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace landfix::platform {
namespace {

constexpr double kMaxCoordinate_m = 1e7;
constexpr double kMaxAngle_deg = 360.0;

/// On one line, and not all of a long one.
std::string text_of(const toml::node& node) {
  constexpr std::size_t kMaxLength = 60;
  std::ostringstream stream;
  node.visit([&stream](const auto& value) { stream << value; });
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength) + "...";
}

std::optional<double> number_of(const toml::node& node) {
  return node.is_number() ? node.value<double>() : std::nullopt;
}

/// Of a list of so many numbers, none of them beyond a coordinate's limit or no number.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers_of(const toml::node& node) {
  const toml::array* const list = node.as_array();
  if (list == nullptr || list->size() != kCount) return std::nullopt;
  std::array<double, kCount> numbers{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::optional<double> number = number_of(*list->get(i));
    if (!number || !(std::abs(*number) <= kMaxCoordinate_m)) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace

std::string place(const std::filesystem::path& file, const toml::source_region& region) {
  return fmt::format("{}:{}:{}", file.string(), region.begin.line, region.begin.column);
}

TomlSection::TomlSection(const std::filesystem::path& file, const toml::table& root, std::string_view name)
    : file_(file), name_(name) {
  const toml::node* const node = root.get(name);
  if (node == nullptr) return;
  table_ = node->as_table();
  if (table_ == nullptr) {
    throw std::runtime_error(
        fmt::format("{}: {} is a section; expected [{}]", place(file_, node->source()), name_, name_));
  }
}

const toml::node* TomlSection::find(std::string_view key) {
  known_keys_.push_back(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

void TomlSection::fail(std::string_view key, const toml::node& node, std::string_view expected) const {
  throw std::runtime_error(fmt::format("{}: {}.{} = {}; expected {}", place(file_, node.source()), name_, key,
                                       text_of(node), expected));
}

void TomlSection::fail(std::string_view key, std::string_view expected) const {
  const toml::node* const node = table_ == nullptr ? nullptr : table_->get(key);
  if (node != nullptr) fail(key, *node, expected);
  throw std::runtime_error(fmt::format("{}: {}.{}: expected {}", file_.string(), name_, key, expected));
}

void TomlSection::require(std::string_view key) const {
  if (table_ != nullptr && table_->contains(key)) return;
  throw std::runtime_error(
      fmt::format("{}: {} is missing; add it to the section [{}]", file_.string(), key, name_));
}

void TomlSection::finish() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    const bool known = std::find(known_keys_.begin(), known_keys_.end(), key.str()) != known_keys_.end();
    if (!known) {
      throw std::runtime_error(fmt::format("{}: unknown key {}; [{}] has {}", place(file_, key.source()),
                                           key.str(), name_, fmt::join(known_keys_, ", ")));
    }
  }
}

void TomlSection::read(std::string_view key, bool& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) fail(key, *node, "true or false");
  value = node->value_or(value);
}

void TomlSection::read(std::string_view key, double& value, Range<double> range) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const std::optional<double> number = number_of(*node);
  // Not a NaN either.
  if (!number || !(*number >= range.low && *number <= range.high)) {
    fail(key, *node, fmt::format("a number from {} to {}", range.low, range.high));
  }
  value = *number;
}

std::int64_t TomlSection::integer(std::string_view key, std::int64_t value, Range<std::int64_t> range) {
  const toml::node* const node = find(key);
  if (node == nullptr) return value;
  const auto number = node->value_exact<std::int64_t>();
  if (!number || *number < range.low || *number > range.high) {
    fail(key, *node, fmt::format("a whole number from {} to {}", range.low, range.high));
  }
  return *number;
}

void TomlSection::read(std::string_view key, std::filesystem::path& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const auto text = node->value_exact<std::string>();
  if (!text || text->find('\0') != text->npos) fail(key, *node, "the name of a file");
  value = text->empty() ? std::filesystem::path() : file_.parent_path() / *text;
}

void TomlSection::read(std::string_view key, std::array<std::uint64_t, 4>& values, std::size_t& count) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const toml::array* const array = node->as_array();
  bool good = array != nullptr && array->size() <= values.size();
  for (std::size_t i = 0; good && i < array->size(); ++i) {
    const auto number = array->get(i)->value_exact<std::int64_t>();
    good = number && *number >= 0;
    values[i] = static_cast<std::uint64_t>(number.value_or(0));
  }
  if (!good) fail(key, *node, fmt::format("a list of at most {} whole numbers from 0 on", values.size()));
  count = array->size();
}

std::vector<TomlSection> TomlSection::tables(std::string_view key, std::string_view name) {
  std::vector<TomlSection> tables;
  const toml::node* const node = find(key);
  if (node == nullptr) return tables;
  const toml::array* const array = node->as_array();
  if (array == nullptr) fail(key, *node, fmt::format("tables, each [[{}]]", name));
  for (const toml::node& element : *array) {
    const toml::table* const table = element.as_table();
    if (table == nullptr) fail(key, element, fmt::format("a table, [[{}]]", name));
    tables.push_back(TomlSection(file_, name, *table));
  }
  return tables;
}

void TomlSection::read(std::string_view key, Eigen::Vector3d& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const auto numbers = numbers_of<3>(*node);
  if (!numbers) fail(key, *node, fmt::format("[x, y, z]: three numbers, metres up to {}", kMaxCoordinate_m));
  value = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

void TomlSection::read(std::string_view key, ndt::Pose& value) {
  std::optional<ndt::Pose> pose;
  read(key, pose);
  if (pose) value = *pose;
}

void TomlSection::read(std::string_view key, std::optional<ndt::Pose>& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const auto numbers = numbers_of<6>(*node);
  const auto is_angle = [](double number) { return std::abs(number) <= kMaxAngle_deg; };
  if (!numbers || !std::all_of(numbers->begin() + 3, numbers->end(), is_angle)) {
    fail(key, *node,
         fmt::format(
             "[x, y, z, roll_deg, pitch_deg, yaw_deg]: six numbers, metres up to {} and degrees up to {}",
             kMaxCoordinate_m, kMaxAngle_deg));
  }
  const auto& [x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg] = *numbers;
  value = ndt::make_pose({x_m, y_m, z_m}, {.roll_rad = roll_deg * ndt::kRadians_per_deg,
                                           .pitch_rad = pitch_deg * ndt::kRadians_per_deg,
                                           .yaw_rad = yaw_deg * ndt::kRadians_per_deg});
}

void TomlSection::read(std::string_view key, std::optional<ndt::PoseGuess>& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const auto numbers = numbers_of<3>(*node);
  if (!numbers || !((*numbers)[2] > 0.0)) {
    fail(key, *node,
         fmt::format("[x, y, radius]: three numbers, metres up to {}, the radius above 0", kMaxCoordinate_m));
  }
  value = {.position_m = {(*numbers)[0], (*numbers)[1]}, .within_m = (*numbers)[2]};
}

}  // namespace landfix::platform
