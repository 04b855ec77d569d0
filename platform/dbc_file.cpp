#include "platform/dbc_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"

namespace landfix::platform {
namespace {

constexpr std::string_view kMessageForm = "BO_ ID NAME: BYTES SENDER";
constexpr std::string_view kSignalForm =
    "SG_ NAME [M|mN] : START|LENGTH@ORDER SIGN (FACTOR,OFFSET) [MIN|MAX] \"UNIT\" RECEIVERS";

struct Place {
  const std::filesystem::path& path;
  std::size_t line = 0;
};

[[noreturn]] void fail(const Place& place, std::string_view what) {
  throw std::runtime_error(fmt::format("{}:{}: {}", place.path.string(), place.line, what));
}

/// Takes a line apart from its front on.
class LineReader {
 public:
  LineReader(std::string_view rest, std::string_view form, const Place& place)
      : rest_(rest), form_(form), place_(place) {}

  [[nodiscard]] bool skip(char expected) {
    blanks();
    if (rest_.empty() || rest_.front() != expected) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char expected) {
    if (!skip(expected)) wrong();
  }
  /// Up to a blank or one of the characters that end names.
  [[nodiscard]] std::string word() {
    blanks();
    const std::size_t size = std::min(rest_.find_first_of(" \t:|@(),[]\""), rest_.size());
    if (size == 0) wrong();
    std::string word(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return word;
  }
  template <class Number>
  [[nodiscard]] Number number() {
    blanks();
    if (rest_.starts_with('+')) rest_.remove_prefix(1);
    Number number{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (error != std::errc()) wrong();
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return number;
  }
  [[nodiscard]] std::string quoted() {
    expect('"');
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) wrong();
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    return text;
  }
  [[noreturn]] void wrong() const { fail(place_, fmt::format("expected {}", form_)); }

 private:
  void blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  std::string_view rest_;
  std::string_view form_;
  Place place_;
};

[[nodiscard]] DbcMessage parse_message(std::string_view rest, const Place& place) {
  constexpr std::uint32_t kExtended = 0x80000000;
  LineReader line(rest, kMessageForm, place);
  DbcMessage message;
  const auto id = line.number<std::uint32_t>();
  message.extended = (id & kExtended) != 0;
  message.id = id & ~kExtended;
  message.name = line.word();
  line.expect(':');
  message.bytes = line.number<std::size_t>();
  return message;
}

[[nodiscard]] DbcSignal parse_signal(std::string_view rest, std::size_t frame_bytes, const Place& place) {
  LineReader line(rest, kSignalForm, place);
  DbcSignal signal{.name = line.word(), .field = {}, .unit = {}, .line = place.line};
  if (!line.skip(':')) {
    signal.multiplexed = line.word() != "M";
    line.expect(':');
  }
  signal.field.start = line.number<std::uint16_t>();
  line.expect('|');
  const auto length = line.number<unsigned>();
  line.expect('@');
  signal.field.motorola = line.skip('0');
  if (!signal.field.motorola) line.expect('1');
  signal.field.is_signed = line.skip('-');
  if (!signal.field.is_signed) line.expect('+');
  line.expect('(');
  signal.scale = line.number<double>();
  line.expect(',');
  signal.offset = line.number<double>();
  line.expect(')');
  line.expect('[');
  (void)line.number<double>();
  line.expect('|');
  (void)line.number<double>();
  line.expect(']');
  signal.unit = line.quoted();
  if (length < 1 || length > 64) fail(place, fmt::format("signal {}: 1 to 64 bits", signal.name));
  signal.field.length = static_cast<std::uint8_t>(length);
  if (bytes_of(signal.field) > frame_bytes)
    fail(place, fmt::format("signal {} does not fit its message of {} bytes", signal.name, frame_bytes));
  if (!std::isfinite(signal.scale) || signal.scale == 0.0 || !std::isfinite(signal.offset))
    fail(place, fmt::format("signal {}: a finite factor that is not 0, and a finite offset", signal.name));
  return signal;
}

/// What follows `key` and a blank, if the line begins with it.
[[nodiscard]] std::optional<std::string_view> after(std::string_view line, std::string_view key) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (!line.starts_with(key)) return std::nullopt;
  line.remove_prefix(key.size());
  if (!line.starts_with(' ') && !line.starts_with('\t')) return std::nullopt;
  return line;
}

}  // namespace

std::vector<DbcMessage> parse_dbc(std::string_view text, const std::filesystem::path& path) {
  std::vector<DbcMessage> messages;
  Place place{path};
  bool in_text = false;  // of a comment, which may hold lines that look like messages
  while (!text.empty()) {
    ++place.line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!in_text) {
      if (const auto message = after(line, "BO_")) messages.push_back(parse_message(*message, place));
      if (const auto signal = after(line, "SG_")) {
        if (messages.empty()) fail(place, "a signal before the first message");
        messages.back().signals.push_back(parse_signal(*signal, messages.back().bytes, place));
      }
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) in_text = !in_text;
    }
  }
  return messages;
}

std::vector<DbcMessage> read_dbc(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return parse_dbc({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace landfix::platform
