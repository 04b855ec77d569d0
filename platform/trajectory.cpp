#include "platform/trajectory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kColumns = 8;
constexpr std::string_view kLayout = "timestamp tx ty tz qx qy qz qw";
constexpr std::string_view kBlank = " \t\r";

/// Where in the file we are: what an error says first.
struct Line {
  std::string_view file;
  std::size_t number = 0;

  [[noreturn]] void fail(std::string_view reason) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", file, number, reason));
  }
};

/// Cuts the next word off `text`; empty at its end.
std::string_view next_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  return word;
}

/// All of `word`, or nothing.
template <class Number>
std::optional<Number> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Decimal seconds, maybe with an exponent as numpy writes them, rounded to nanoseconds. A double would not
/// do: it holds today's Unix time only to a quarter of a microsecond.
std::optional<std::int64_t> parse_seconds(std::string_view word) {
  const std::size_t e = word.find_first_of("eE");
  const auto exponent =
      e == std::string_view::npos ? std::optional<int>(0) : parse_number<int>(word.substr(e + 1));
  const std::string_view mantissa = word.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  std::string digits(mantissa.substr(0, point));
  if (point < mantissa.size()) digits += mantissa.substr(point + 1);
  if (!exponent || *exponent < -20 || *exponent > 20 || digits.empty() || digits.size() > 100 ||
      !all_digits(digits)) {
    return std::nullopt;
  }
  const int whole_digits = static_cast<int>(point) + *exponent + 9;  // of the number in nanoseconds
  if (whole_digits < 0) return 0;
  const auto whole = static_cast<std::size_t>(whole_digits);
  const bool round_up = whole < digits.size() && digits[whole] >= '5';
  digits.resize(whole, '0');
  const auto nanoseconds = parse_number<std::int64_t>(digits.empty() ? "0" : std::string_view(digits));
  if (!nanoseconds || *nanoseconds > std::numeric_limits<std::int64_t>::max() - 1) return std::nullopt;
  return *nanoseconds + (round_up ? 1 : 0);
}

StampedPose parse_line(std::string_view text, const Line& line) {
  std::array<std::string_view, kColumns> words;
  std::size_t columns = 0;
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
    if (columns < kColumns) words[columns] = word;
    ++columns;
  }
  if (columns != kColumns) line.fail(fmt::format("{} columns; expected {}: {}", columns, kColumns, kLayout));

  const std::optional<std::int64_t> stamp_utc_ns = parse_seconds(words[0]);
  if (!stamp_utc_ns) line.fail(fmt::format("'{}' is not a time in seconds", words[0]));
  std::array<double, kColumns - 1> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = parse_number<double>(words[i + 1]);
    if (!value || !std::isfinite(*value)) {
      line.fail(fmt::format("column {}: '{}' is not a finite number", i + 2, words[i + 1]));
    }
    values[i] = *value;
  }
  const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
  const double norm = rotation.coeffs().stableNorm();
  if (norm < 1e-6 || !std::isfinite(norm)) line.fail("the quaternion qx qy qz qw has no direction");
  StampedPose pose{.stamp_utc_ns = *stamp_utc_ns};
  pose.pose.translation() = Eigen::Vector3d(values[0], values[1], values[2]);
  pose.pose.linear() = Eigen::Quaterniond(rotation.coeffs() / norm).toRotationMatrix();
  return pose;
}

}  // namespace

std::vector<StampedPose> parse_tum(std::string_view text, std::string_view name) {
  std::vector<StampedPose> poses;
  Line line{.file = name};
  while (!text.empty()) {
    ++line.number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view content = text.substr(0, std::min(text.find('#'), end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (content.find_first_not_of(kBlank) == std::string_view::npos) continue;
    poses.push_back(parse_line(content, line));
    if (poses.size() > 1 && poses.back().stamp_utc_ns <= std::prev(poses.end(), 2)->stamp_utc_ns) {
      line.fail("the time is not later than that of the pose before; sort the poses by time");
    }
  }
  return poses;
}

std::vector<StampedPose> read_tum(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return parse_tum({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

std::string format_tum(std::span<const StampedPose> poses) {
  std::string text = fmt::format("# {}\n", kLayout);
  for (const StampedPose& stamped : poses) {
    const Eigen::Vector3d t = stamped.pose.translation();
    Eigen::Quaterniond q(stamped.pose.linear());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    text += fmt::format("{}.{:09} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                        stamped.stamp_utc_ns / kNs_per_s, stamped.stamp_utc_ns % kNs_per_s, t.x(), t.y(),
                        t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

void write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses) {
  AtomicFile file(path);
  file.write(format_tum(poses));
  file.commit();
}

std::optional<ndt::Pose> interpolate(std::span<const StampedPose> poses, std::int64_t stamp_utc_ns) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp_utc_ns,
                       [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_utc_ns < stamp; });
  if (after == poses.end()) return std::nullopt;
  if (after->stamp_utc_ns == stamp_utc_ns) return after->pose;
  if (after == poses.begin()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const double share = static_cast<double>(stamp_utc_ns - before.stamp_utc_ns) /
                       static_cast<double>(after->stamp_utc_ns - before.stamp_utc_ns);
  const Eigen::Quaterniond from(before.pose.linear());
  const Eigen::Quaterniond to(after->pose.linear());
  ndt::Pose pose = ndt::Pose::Identity();
  pose.linear() = from.slerp(share, to).toRotationMatrix();
  pose.translation() = (1.0 - share) * before.pose.translation() + share * after->pose.translation();
  return pose;
}

}  // namespace landfix::platform
