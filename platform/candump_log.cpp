#include "platform/candump_log.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace landfix::platform {
namespace {

constexpr std::size_t kMaxInterfaceLength = 15;  // IFNAMSIZ, less its final zero
constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
constexpr std::uint8_t kBitRateSwitch = 1;  // the flags of CAN FD: CANFD_BRS
constexpr std::string_view kHexDigits = "0123456789ABCDEF";

/// Takes what `text` begins with up to `end`, and `end`; nothing if there is no such end.
std::optional<std::string_view> take_until(std::string_view& text, char end) noexcept {
  const std::size_t position = text.find(end);
  if (position == std::string_view::npos) return std::nullopt;
  const std::string_view taken = text.substr(0, position);
  text.remove_prefix(position + 1);
  return taken;
}

template <class Number>
std::optional<Number> parse_unsigned(std::string_view digits, int base) noexcept {
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  const bool all = !digits.empty() && digits.front() != '-' && end == digits.data() + digits.size();
  return error == std::errc() && all ? std::optional(value) : std::nullopt;
}

/// Seconds with a fraction of 1 to 9 digits.
std::optional<std::int64_t> parse_stamp(std::string_view text) noexcept {
  const auto seconds_text = take_until(text, '.');
  if (!seconds_text || text.size() > 9) return std::nullopt;
  const auto seconds = parse_unsigned<std::int64_t>(*seconds_text, 10);
  auto fraction_ns = parse_unsigned<std::int64_t>(text, 10);
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;
  if (!seconds || !fraction_ns || *seconds > kMaxSeconds) return std::nullopt;
  for (std::size_t digits = text.size(); digits < 9; ++digits) *fraction_ns *= 10;
  return *seconds * 1'000'000'000 + *fraction_ns;
}

/// Three digits of identifier are the 11-bit format, eight the 29-bit one.
bool parse_id(std::string_view text, CanFrame& frame) noexcept {
  const auto id = parse_unsigned<std::uint32_t>(text, 16);
  if (!id || (text.size() != 3 && text.size() != 8)) return false;
  frame.extended = text.size() == 8;
  frame.id = *id;
  return *id <= (frame.extended ? kMaxExtendedId : kMaxStandardId);
}

/// The second # of CAN FD and its digit of flags, where they are.
bool parse_fd(std::string_view& text, CanFrame& frame) noexcept {
  frame.fd = text.starts_with('#');
  if (!frame.fd) return true;
  const auto flags = parse_unsigned<std::uint8_t>(text.substr(1, 1), 16);
  if (!flags) return false;
  frame.bit_rate_switch = (*flags & kBitRateSwitch) != 0;
  text.remove_prefix(2);
  return true;
}

/// Pairs of digits, dots between them allowed.
bool parse_data(std::string_view text, CanFrame& frame) noexcept {
  while (!text.empty()) {
    const auto byte = parse_unsigned<std::uint8_t>(text.substr(0, 2), 16);
    if (text.size() < 2 || !byte || frame.length == frame.data.size()) return false;
    frame.data[frame.length++] = std::byte{*byte};
    text.remove_prefix(2);
    if (text.size() > 1 && text.front() == '.') text.remove_prefix(1);
  }
  return is_can_length(frame.length, frame.fd);
}

}  // namespace

bool is_can_interface_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= kMaxInterfaceLength &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 0x7F && c != '/'; });
}

CandumpLog::CandumpLog(std::filesystem::path path, std::string interface)
    : file_(std::move(path)), interface_(std::move(interface)) {
  if (!is_can_interface_name(interface_)) {
    throw std::runtime_error(
        fmt::format("'{}' is no name of a CAN interface: 1 to {} characters without blanks, such as can0",
                    interface_, kMaxInterfaceLength));
  }
}

std::size_t CandumpLog::send(std::span<const CanFrame> group, std::int64_t stamp_utc_ns) noexcept {
  std::size_t taken = 0;
  while (taken < group.size() && write(group[taken], stamp_utc_ns)) ++taken;
  return taken;
}

bool CandumpLog::write(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept {
  if (failed_) return false;
  try {
    std::array<char, 192> line;
    char* out = fmt::format_to(line.data(), "({}.{:06}) {} ", stamp_utc_ns / 1'000'000'000,
                               stamp_utc_ns / 1'000 % 1'000'000, interface_);
    out =
        frame.extended ? fmt::format_to(out, "{:08X}#", frame.id) : fmt::format_to(out, "{:03X}#", frame.id);
    if (frame.fd) out = fmt::format_to(out, "#{:X}", frame.bit_rate_switch ? kBitRateSwitch : 0);
    for (const std::byte byte : frame.payload()) {
      *out++ = kHexDigits[std::to_integer<std::size_t>(byte >> 4)];
      *out++ = kHexDigits[std::to_integer<std::size_t>(byte & std::byte{0xF})];
    }
    *out++ = '\n';
    file_.write(std::string_view(line.data(), static_cast<std::size_t>(out - line.data())));
  } catch (const std::exception&) {
    failed_ = true;
  }
  return !failed_;
}

void CandumpLog::commit() {
  if (failed_)
    throw std::runtime_error(file_.temporary_path().string() +
                             ": cannot write the CAN log; is the disk full?");
  file_.commit();
}

std::optional<LoggedFrame> parse_candump_line(std::string_view line) noexcept {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  // Newer versions append the direction.
  if (line.ends_with(" R") || line.ends_with(" T")) line.remove_suffix(2);

  if (!line.starts_with('(')) return std::nullopt;
  line.remove_prefix(1);
  const auto stamp = take_until(line, ')');
  if (!stamp || !line.starts_with(' ')) return std::nullopt;
  line.remove_prefix(1);
  const auto interface = take_until(line, ' ');
  const auto id = take_until(line, '#');
  if (!interface || !id || !is_can_interface_name(*interface)) return std::nullopt;

  LoggedFrame logged{.interface = *interface};
  const auto stamp_utc_ns = parse_stamp(*stamp);
  if (!stamp_utc_ns || !parse_id(*id, logged.frame) || !parse_fd(line, logged.frame) ||
      !parse_data(line, logged.frame)) {
    return std::nullopt;
  }
  logged.stamp_utc_ns = *stamp_utc_ns;
  return logged;
}

std::vector<StampedFrame> read_candump(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<StampedFrame> frames;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto logged = parse_candump_line(text.substr(0, end)))
      frames.push_back({logged->stamp_utc_ns, logged->frame});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (frames.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no CAN frame in it; expected a log as candump -l writes it", path.string()));
  }
  std::stable_sort(frames.begin(), frames.end(), [](const StampedFrame& a, const StampedFrame& b) {
    return a.stamp_utc_ns < b.stamp_utc_ns;
  });
  return frames;
}

}  // namespace landfix::platform
