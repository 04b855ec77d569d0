#include "ndt/pcd.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include "ndt/pcd_header.hpp"
#include "ndt/pcd_text.hpp"

namespace landfix::ndt {
namespace {

using pcd::fail;
using pcd::fail_at;

using Bytes = std::span<const std::byte>;

[[nodiscard]] std::optional<double> to_double(std::string_view word) noexcept {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
  if (error != std::errc()) return std::nullopt;
  return value;
}

template <class T>
[[nodiscard]] double load(const std::byte* bytes) noexcept {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// Reads an element of a field's type.
using Load = double (*)(const std::byte*) noexcept;

[[nodiscard]] Load load_of(const PcdField& field) noexcept {
  if (field.type == 'F') return field.size == 4 ? load<float> : load<double>;
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? load<std::int8_t> : load<std::uint8_t>;
    case 2:
      return is_signed ? load<std::int16_t> : load<std::uint16_t>;
    case 4:
      return is_signed ? load<std::int32_t> : load<std::uint32_t>;
    default:
      return is_signed ? load<std::int64_t> : load<std::uint64_t>;
  }
}

/// The fields that a caller asked for, by their place in the file; npos where the file has none.
[[nodiscard]] std::vector<std::size_t> find_columns(const PcdHeader& header, const std::string& name,
                                                    std::span<const std::string_view> columns) {
  std::vector<std::size_t> places;
  for (const std::string_view column : columns) {
    const auto found = std::find_if(header.fields.begin(), header.fields.end(),
                                    [column](const PcdField& field) { return field.name == column; });
    const bool is_missing = found == header.fields.end();
    if (is_missing && (column == "x" || column == "y" || column == "z")) {
      fail(name, fmt::format("the cloud has no field {}", column));
    }
    places.push_back(is_missing ? std::string::npos
                                : static_cast<std::size_t>(std::distance(header.fields.begin(), found)));
  }
  return places;
}

using Visit = std::function<void(std::span<const double>)>;

void visit_ascii(const PcdHeader& header, Bytes file, const std::string& name,
                 std::span<const std::size_t> places, const Visit& visit) {
  // Where each column's first element stands among the words of a line.
  std::vector<std::size_t> word_of_field;
  std::size_t words_a_line = 0;
  for (const PcdField& field : header.fields) {
    word_of_field.push_back(words_a_line);
    words_a_line += field.count;
  }
  const std::size_t header_lines = static_cast<std::size_t>(std::count(
      file.begin(), file.begin() + static_cast<std::ptrdiff_t>(header.data_offset), std::byte{'\n'}));
  pcd::Lines lines(pcd::as_text(file.subspan(header.data_offset)));
  std::vector<double> words(words_a_line);
  std::vector<double> row(places.size(), std::numeric_limits<double>::quiet_NaN());
  std::size_t points = 0;
  while (points < header.points) {
    const auto line = lines.next();
    if (!line) fail(name, fmt::format("truncated: {} points of {}", points, header.points));
    pcd::Words split(*line);
    std::string_view word = split.next();
    if (word.empty()) continue;
    for (double& value : words) {
      const auto number = to_double(word);
      if (!number) {
        fail_at(name, header_lines + lines.number(),
                word.empty() ? fmt::format("{} numbers expected", words_a_line)
                             : fmt::format("{} is not a number", pcd::quoted(word)));
      }
      value = *number;
      word = split.next();
    }
    if (!word.empty())
      fail_at(name, header_lines + lines.number(), fmt::format("more than {} numbers", words_a_line));
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] != std::string::npos) row[i] = words[word_of_field[places[i]]];
    }
    visit(row);
    ++points;
  }
}

/// Where the first elements of a column lie, and how they are read.
struct Column {
  Load load = nullptr;
  const std::byte* first = nullptr;
  std::size_t stride = 0;  ///< bytes from point to point
  std::size_t place = 0;   ///< in the caller's row
};

/// `column_of(field)` gives a column without load and place.
template <class ColumnOf>
void visit_elements(const PcdHeader& header, std::span<const std::size_t> places, const Visit& visit,
                    ColumnOf column_of) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == std::string::npos) continue;
    const PcdField& field = header.fields[places[i]];
    columns.push_back(column_of(field));
    columns.back().load = load_of(field);
    columns.back().place = i;
  }
  std::vector<double> row(places.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t point = 0; point < header.points; ++point) {
    for (const Column& column : columns)
      row[column.place] = column.load(column.first + point * column.stride);
    visit(row);
  }
}

void visit_binary(const PcdHeader& header, Bytes file, const std::string& name,
                  std::span<const std::size_t> places, const Visit& visit) {
  const Bytes data = file.subspan(header.data_offset);
  if (data.size() / header.point_size < header.points) {
    fail(name, fmt::format("truncated: byte {} of {}", file.size(),
                           header.data_offset + header.points * header.point_size));
  }
  visit_elements(header, places, visit, [&](const PcdField& field) {
    return Column{.first = data.data() + field.offset, .stride = header.point_size};
  });
}

void visit_compressed(const PcdHeader& header, Bytes file, const std::string& name,
                      std::span<const std::size_t> places, const Visit& visit) {
  const Bytes data = file.subspan(header.data_offset);
  std::array<std::uint32_t, 2> sizes{};
  if (data.size() < sizeof sizes)
    fail(name, fmt::format("truncated: byte {}, no sizes of the data", file.size()));
  std::memcpy(sizes.data(), data.data(), sizeof sizes);
  const auto [compressed, uncompressed] = sizes;
  if (compressed > data.size() - sizeof sizes) {
    fail(name, fmt::format("truncated: byte {} of {}", file.size(),
                           header.data_offset + sizeof sizes + compressed));
  }
  if (header.points > std::numeric_limits<std::uint32_t>::max() / header.point_size ||
      uncompressed != header.points * header.point_size) {
    fail(name, fmt::format("{} points of {} bytes do not make the {} bytes that the data claims",
                           header.points, header.point_size, uncompressed));
  }
  // LZF copies at most 264 bytes for three: a larger claim is a damaged file, not a reason to allocate.
  if (uncompressed / 264 > compressed)
    fail(name, "its compressed data cannot hold what it claims: it is damaged");
  std::vector<std::byte> points(uncompressed);
  if (uncompressed != 0 &&
      lzf_decompress(data.data() + sizeof sizes, compressed, points.data(), uncompressed) != uncompressed) {
    fail(name, "its compressed data is damaged");
  }
  // Field by field: all x, all y, ...
  visit_elements(header, places, visit, [&](const PcdField& field) {
    return Column{.first = points.data() + header.points * field.offset, .stride = field.size * field.count};
  });
}

}  // namespace

void visit_pcd(Bytes file, const std::string& name, std::span<const std::string_view> columns,
               const Visit& visit) {
  const PcdHeader header = read_pcd_header(file, name);
  const std::vector<std::size_t> places = find_columns(header, name, columns);
  switch (header.data) {
    case PcdHeader::Data::ascii:
      visit_ascii(header, file, name, places, visit);
      break;
    case PcdHeader::Data::binary:
      visit_binary(header, file, name, places, visit);
      break;
    case PcdHeader::Data::binary_compressed:
      visit_compressed(header, file, name, places, visit);
      break;
  }
}

void visit_pcd_positions(Bytes file, const std::string& name,
                         const std::function<void(const Eigen::Vector3d&)>& visit) {
  constexpr std::array<std::string_view, 3> kColumns{"x", "y", "z"};
  visit_pcd(file, name, kColumns, [&visit](std::span<const double> row) {
    const Eigen::Vector3d position_m(row[0], row[1], row[2]);
    if (position_m.allFinite()) visit(position_m);
  });
}

}  // namespace landfix::ndt
