#include "ndt/pcd_header.hpp"

#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "ndt/pcd_text.hpp"

namespace landfix::ndt {
namespace {

using pcd::fail;
using pcd::fail_at;
using pcd::quoted;
using pcd::Words;

/// More bytes a point than any cloud has: a larger number is a damaged header.
constexpr std::size_t kMaxPointSize = 1 << 16;

[[nodiscard]] std::optional<std::size_t> to_size(std::string_view word) noexcept {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

[[nodiscard]] bool is_known(char type, std::size_t size) noexcept {
  if (type == 'F') return size == 4 || size == 8;
  return (type == 'I' || type == 'U') && (size == 1 || size == 2 || size == 4 || size == 8);
}

/// What the header's lines say, before it is checked.
struct RawHeader {
  std::vector<std::string> names;
  std::vector<std::size_t> sizes;
  std::vector<char> types;
  std::vector<std::size_t> counts;
  std::optional<std::size_t> width;
  std::optional<std::size_t> height;
  std::optional<std::size_t> points;
};

void read_header_line(RawHeader& raw, std::string_view key, Words words, const std::string& name,
                      std::size_t line) {
  const auto sizes = [&](std::vector<std::size_t>& values) {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto value = to_size(word);
      if (!value) fail_at(name, line, fmt::format("{} is not a count", quoted(word)));
      values.push_back(*value);
    }
  };
  const auto one = [&](std::optional<std::size_t>& value) {
    const std::string_view word = words.next();
    value = to_size(word);
    if (!value) fail_at(name, line, fmt::format("{} {} is not a count", key, quoted(word)));
  };
  if (key == "FIELDS") {
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      raw.names.emplace_back(word);
  } else if (key == "SIZE") {
    sizes(raw.sizes);
  } else if (key == "TYPE") {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      raw.types.push_back(word.size() == 1 ? word.front() : '?');
    }
  } else if (key == "COUNT") {
    sizes(raw.counts);
  } else if (key == "WIDTH") {
    one(raw.width);
  } else if (key == "HEIGHT") {
    one(raw.height);
  } else if (key == "POINTS") {
    one(raw.points);
  } else if (key != "VERSION" && key != "VIEWPOINT") {
    fail_at(name, line, fmt::format("{} is not a line of a PCD header", quoted(key)));
  }
}

/// Lays out the fields and counts the points.
[[nodiscard]] PcdHeader check_header(const RawHeader& raw, const std::string& name) {
  PcdHeader header;
  if (raw.names.empty()) fail(name, "not a PCD file: no FIELDS");
  if (raw.sizes.size() != raw.names.size() || raw.types.size() != raw.names.size() ||
      (!raw.counts.empty() && raw.counts.size() != raw.names.size())) {
    fail(name, fmt::format("{} FIELDS, but {} SIZE, {} TYPE and {} COUNT", raw.names.size(), raw.sizes.size(),
                           raw.types.size(), raw.counts.size()));
  }
  for (std::size_t i = 0; i < raw.names.size(); ++i) {
    const std::size_t count = raw.counts.empty() ? 1 : raw.counts[i];
    if (!is_known(raw.types[i], raw.sizes[i])) {
      fail(name, fmt::format("field {}: no such type as {}{}", raw.names[i], raw.types[i], raw.sizes[i]));
    }
    if (count == 0 || count > kMaxPointSize)
      fail(name, fmt::format("field {}: COUNT {}", raw.names[i], count));
    header.fields.push_back({raw.names[i], raw.types[i], raw.sizes[i], count, header.point_size});
    header.point_size += raw.sizes[i] * count;
    if (header.point_size > kMaxPointSize)
      fail(name, fmt::format("more than {} bytes a point", kMaxPointSize));
  }
  const std::size_t height = raw.height.value_or(1);
  if (!raw.points && !raw.width) fail(name, "neither POINTS nor WIDTH");
  if (raw.width && height != 0 && *raw.width > std::numeric_limits<std::size_t>::max() / height) {
    fail(name, fmt::format("WIDTH {} times HEIGHT {} is no number of points", *raw.width, height));
  }
  header.points = raw.points ? *raw.points : *raw.width * height;
  if (raw.width && *raw.width * height != header.points) {
    fail(name, fmt::format("POINTS {} is not WIDTH {} times HEIGHT {}", header.points, *raw.width, height));
  }
  return header;
}

}  // namespace

PcdHeader read_pcd_header(std::span<const std::byte> file, const std::string& name) {
  RawHeader raw;
  pcd::Lines lines(pcd::as_text(file));
  while (const auto line = lines.next()) {
    Words words(*line);
    const std::string_view key = words.next();
    if (key.empty() || key.front() == '#') continue;
    if (key != "DATA") {
      read_header_line(raw, key, words, name, lines.number());
      continue;
    }
    PcdHeader header = check_header(raw, name);
    header.data_offset = lines.position();
    const std::string_view data = words.next();
    if (data == "ascii") {
      header.data = PcdHeader::Data::ascii;
    } else if (data == "binary") {
      header.data = PcdHeader::Data::binary;
    } else if (data == "binary_compressed") {
      header.data = PcdHeader::Data::binary_compressed;
    } else {
      fail_at(name, lines.number(),
              fmt::format("DATA {} is not ascii, binary or binary_compressed", quoted(data)));
    }
    return header;
  }
  fail(name, "not a PCD file: no DATA line");
}

}  // namespace landfix::ndt
