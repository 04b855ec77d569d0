#include "drivers/ouster/metadata_json.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/calibration_text.hpp"

namespace landfix::drivers::ouster {
namespace {

/// The largest there is are 50 kB, and five levels deep.
constexpr std::size_t kMostBytes = 1 << 20;
constexpr int kDeepest = 16;

std::size_t line_at(std::string_view text, std::size_t offset) {
  return 1 +
         static_cast<std::size_t>(std::count(
             text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size())), '\n'));
}

std::string between(double least, double most) {
  const auto shown = [](double value) { return std::to_string(static_cast<long long>(value)); };
  return "between " + shown(least) + " and " + shown(most);
}

bool is_within(const nlohmann::json& value, double least, double most) {
  return value.is_number() && value.get<double>() >= least && value.get<double>() <= most;
}

}  // namespace

MetadataJson::MetadataJson(std::span<const std::byte> file, std::string_view name)
    : text_(to_text(file)), name_(name) {
  constexpr const char* kHint = "; get the metadata from http://SENSOR/api/v1/sensor/metadata";
  if (text_.size() > kMostBytes)
    drivers::fail(name_, 1, std::string("more than 1 MiB is no metadata") + kHint);
  const auto bounded = [&](int depth, nlohmann::json::parse_event_t /*event*/, nlohmann::json& /*value*/) {
    if (depth > kDeepest) drivers::fail(name_, 1, std::string("nested too deep for metadata") + kHint);
    return true;
  };
  try {
    root_ = nlohmann::json::parse(text_, bounded);
  } catch (const nlohmann::json::parse_error& error) {
    drivers::fail(name_, line_at(text_, error.byte), std::string("no JSON, from here on") + kHint);
  } catch (const nlohmann::json::out_of_range&) {
    drivers::fail(name_, 1, std::string("a number is too large") + kHint);
  }
  if (!root_.is_object()) drivers::fail(name_, 1, std::string("no JSON object") + kHint);
}

const nlohmann::json* MetadataJson::find(std::initializer_list<const char*> sections, const char* key) const {
  for (const char* const section : sections) {
    const auto found = root_.find(section);
    if (found == root_.end() || !found->is_object()) continue;
    const auto value = found->find(key);
    if (value != found->end() && !value->is_null()) return &*value;
  }
  const auto value = root_.find(key);
  return value != root_.end() && !value->is_null() ? &*value : nullptr;
}

std::optional<std::string> MetadataJson::text(std::initializer_list<const char*> sections,
                                              const char* key) const {
  const nlohmann::json* const value = find(sections, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) fail(key, "is not a string");
  return value->get<std::string>();
}

std::optional<double> MetadataJson::number(std::initializer_list<const char*> sections, const char* key,
                                           double least, double most) const {
  const nlohmann::json* const value = find(sections, key);
  if (value == nullptr) return std::nullopt;
  if (!is_within(*value, least, most)) fail(key, "is not a number " + between(least, most));
  return value->get<double>();
}

std::optional<std::size_t> MetadataJson::count(std::initializer_list<const char*> sections, const char* key,
                                               std::size_t least, std::size_t most) const {
  const auto value = number(sections, key, static_cast<double>(least), static_cast<double>(most));
  if (!value) return std::nullopt;
  if (*value != std::floor(*value)) fail(key, "is not a whole number");
  return static_cast<std::size_t>(*value);
}

std::optional<std::vector<double>> MetadataJson::numbers(std::initializer_list<const char*> sections,
                                                         const char* key, double least, double most) const {
  const nlohmann::json* const value = find(sections, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_array()) fail(key, "is not an array of numbers");
  std::vector<double> numbers;
  for (const nlohmann::json& element : *value) {
    if (!is_within(element, least, most)) {
      fail(key, "element " + std::to_string(numbers.size()) + " is not a number " + between(least, most));
    }
    numbers.push_back(element.get<double>());
  }
  return numbers;
}

void MetadataJson::fail(const char* key, const std::string& what) const {
  const std::size_t at = text_.find('"' + std::string(key) + '"');
  const std::string message = std::string(key) + ": " + what;
  if (at == std::string_view::npos) throw std::runtime_error(name_ + ": " + message);
  drivers::fail(name_, line_at(text_, at), message);
}

}  // namespace landfix::drivers::ouster
