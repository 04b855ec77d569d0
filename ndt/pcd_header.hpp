// The header of a PCD 0.7 file, checked: what its points are made of and where they begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace landfix::ndt {

struct PcdField {
  std::string name;
  char type = 'F';         ///< F float, I signed, U unsigned
  std::size_t size = 4;    ///< bytes of one element
  std::size_t count = 1;   ///< elements
  std::size_t offset = 0;  ///< of its first element in a point
};

struct PcdHeader {
  enum class Data : std::uint8_t { ascii, binary, binary_compressed };

  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t point_size = 0;  ///< bytes of one point, binary
  Data data = Data::ascii;
  std::size_t data_offset = 0;  ///< of the first byte after the header
};

/// Throws std::runtime_error that begins with `name` and says what is wrong, at which line.
[[nodiscard]] PcdHeader read_pcd_header(std::span<const std::byte> file, const std::string& name);

}  // namespace landfix::ndt
