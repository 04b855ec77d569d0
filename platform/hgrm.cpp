#include "platform/hgrm.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"

namespace landfix::platform {
namespace {

constexpr double kMs_per_ns = 1e-6;

[[nodiscard]] std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Takes the first word off the line.
[[nodiscard]] std::string_view take_word(std::string_view& line) {
  line = trim(line);
  const std::string_view word = line.substr(0, std::min(line.find_first_of(" \t"), line.size()));
  line.remove_prefix(word.size());
  return word;
}

template <class Number>
[[nodiscard]] std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// What stands behind "KEY =" in a line "#[KEY = VALUE, KEY = VALUE]"; empty if nothing does.
[[nodiscard]] std::string_view value_of(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = trim(line.substr(at + key.size()));
  if (!rest.starts_with('=')) return {};
  rest.remove_prefix(1);
  return trim(rest.substr(0, rest.find_first_of(",]")));
}

void read_footer(std::string_view line, LatencyDistribution& distribution) {
  const auto read = [line](std::string_view key, double& value) {
    const auto number = number_of<double>(value_of(line, key));
    if (number && std::isfinite(*number)) value = *number;
  };
  read("Mean", distribution.mean_ms);
  read("StdDeviation", distribution.deviation_ms);
  read("Max", distribution.max_ms);
  if (const std::string_view stage = value_of(line, "Stage"); !stage.empty()) distribution.stage = stage;
}

[[nodiscard]] std::optional<LatencyDistribution::Step> read_step(std::string_view line) {
  const auto value_ms = number_of<double>(take_word(line));
  const auto percentile = number_of<double>(take_word(line));
  const auto count = number_of<std::uint64_t>(take_word(line));
  if (!value_ms || !percentile || !count || !std::isfinite(*value_ms) || *value_ms < 0.0) return std::nullopt;
  return LatencyDistribution::Step{*value_ms, *count};
}

}  // namespace

double LatencyDistribution::percentile_ms(double percent) const {
  if (count() == 0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::max(1.0, std::ceil(percent / 100.0 * static_cast<double>(count())));
  const auto found = std::partition_point(steps.begin(), steps.end(), [rank](const Step& step) {
    return static_cast<double>(step.count) < rank;
  });
  return found == steps.end() ? steps.back().value_ms : found->value_ms;
}

LatencyDistribution distribution_of(const LatencyHistogram& histogram, std::string_view stage) {
  LatencyDistribution distribution;
  distribution.stage = stage;
  std::uint64_t count = 0;
  double sum_ms = 0.0;
  double squares_ms2 = 0.0;
  histogram.visit_counters([&](std::int64_t highest_ns, std::uint64_t values) {
    const double value_ms = static_cast<double>(std::min(highest_ns, histogram.max_ns())) * kMs_per_ns;
    count += values;
    sum_ms += value_ms * static_cast<double>(values);
    squares_ms2 += value_ms * value_ms * static_cast<double>(values);
    distribution.steps.push_back({value_ms, count});
  });
  if (count == 0) return distribution;
  distribution.mean_ms = sum_ms / static_cast<double>(count);
  const double variance_ms2 =
      squares_ms2 / static_cast<double>(count) - distribution.mean_ms * distribution.mean_ms;
  distribution.deviation_ms = std::sqrt(std::max(variance_ms2, 0.0));
  distribution.max_ms = static_cast<double>(histogram.max_ns()) * kMs_per_ns;
  return distribution;
}

std::string to_hgrm(const LatencyDistribution& distribution) {
  std::string text;
  const auto add = [&text]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
    text += fmt::format(format, std::forward<Values>(values)...);
  };
  add("{:>12} {:>14} {:>10} {:>14}\n\n", "Value", "Percentile", "TotalCount", "1/(1-Percentile)");
  const std::uint64_t all = distribution.count();
  for (const auto& [value_ms, count] : distribution.steps) {
    const double share = static_cast<double>(count) / static_cast<double>(all);
    if (count < all)
      add("{:12.6f} {:2.12f} {:10} {:14.2f}\n", value_ms, share, count, 1.0 / (1.0 - share));
    else
      add("{:12.6f} {:2.12f} {:10}\n", value_ms, share, count);
  }
  add("#[Mean    = {:12.6f}, StdDeviation   = {:12.6f}]\n", distribution.mean_ms, distribution.deviation_ms);
  add("#[Max     = {:12.6f}, Total count    = {:12}]\n", distribution.max_ms, all);
  add("#[Buckets = {:12}, SubBuckets     = {:12}]\n", LatencyHistogram::kBuckets,
      LatencyHistogram::kSubBucketCount);
  if (!distribution.stage.empty()) add("#[Stage   = {}]\n", distribution.stage);
  return text;
}

LatencyDistribution parse_hgrm(std::string_view text, std::string_view name) {
  LatencyDistribution distribution;
  bool has_title = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = trim(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
    if (line.empty()) continue;
    if (line.starts_with('#')) {
      read_footer(line, distribution);
    } else if (line.starts_with("Value")) {
      has_title = true;
    } else {
      const auto step = read_step(line);
      const bool rises =
          step && (distribution.steps.empty() || (step->value_ms >= distribution.steps.back().value_ms &&
                                                  step->count >= distribution.steps.back().count));
      if (!has_title || !rises) {
        throw std::runtime_error(fmt::format(
            "{}:{}: expected {}", name, number,
            has_title ? "value, percentile and count, each at least what it was in the line above"
                      : "the title \"Value Percentile TotalCount 1/(1-Percentile)\" of an .hgrm"));
      }
      distribution.steps.push_back(*step);
    }
  }
  if (!has_title) throw std::runtime_error(fmt::format("{}: no .hgrm file: it has no title", name));
  if (!distribution.steps.empty()) {
    distribution.max_ms = std::max(distribution.max_ms, distribution.steps.back().value_ms);
  }
  return distribution;
}

LatencyDistribution read_hgrm(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return parse_hgrm({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

std::filesystem::path hgrm_of_stage(const std::filesystem::path& path, std::string_view stage) {
  std::filesystem::path of_stage = path;
  of_stage.replace_extension(fmt::format(".{}.hgrm", stage));
  return of_stage;
}

}  // namespace landfix::platform
