// Square cells, each of a class or empty, as paths of an SVG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace landfix::tools {

struct ClassGrid {
  static constexpr std::uint8_t kEmpty = 255;

  std::size_t columns = 0;
  std::size_t rows = 0;               ///< from the top
  std::vector<std::uint8_t> classes;  ///< row by row

  [[nodiscard]] std::uint8_t at(std::size_t column, std::size_t row) const {
    return classes[row * columns + column];
  }
};

/// A path a class, in units of cells: x to the right, y down from the upper left corner. Runs of one class in
/// a row are one rectangle.
[[nodiscard]] std::vector<std::string> class_paths(const ClassGrid& grid, std::size_t classes);

}  // namespace landfix::tools
