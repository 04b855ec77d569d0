// How the text of a PCD file is taken apart, and how its errors are worded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace landfix::ndt::pcd {

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Words of a line, apart by blanks; also takes the carriage return of files from Windows.
class Words {
 public:
  explicit Words(std::string_view line) noexcept : rest_(line) {}

  [[nodiscard]] std::string_view next() noexcept {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    const std::size_t begin = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(kBlanks, begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

/// The lines of a text, counted from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) noexcept : text_(text) {}

  [[nodiscard]] std::optional<std::string_view> next() noexcept {
    if (position_ >= text_.size()) return std::nullopt;
    ++number_;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    const std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    return line;
  }
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  [[nodiscard]] std::size_t position() const noexcept { return position_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
};

/// What an error quotes of a file that may not be text at all.
[[nodiscard]] inline std::string quoted(std::string_view word) {
  constexpr std::size_t kMaxLength = 32;
  std::string text(word.substr(0, kMaxLength));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("'{}{}'", text, word.size() > kMaxLength ? "..." : "");
}

[[noreturn]] inline void fail(const std::string& name, const std::string& why) {
  throw std::runtime_error(name + ": " + why);
}

[[noreturn]] inline void fail_at(const std::string& name, std::size_t line, const std::string& why) {
  fail(name, fmt::format("line {}: {}", line, why));
}

}  // namespace landfix::ndt::pcd
