#include "tools/class_grid.hpp"

#include <fmt/format.h>

namespace landfix::tools {

std::vector<std::string> class_paths(const ClassGrid& grid, std::size_t classes) {
  std::vector<std::string> paths(classes);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns;) {
      const std::uint8_t kind = grid.at(column, row);
      std::size_t end = column + 1;
      while (end < grid.columns && grid.at(end, row) == kind) ++end;
      if (kind != ClassGrid::kEmpty)
        paths[kind] += fmt::format("M{} {}h{}v1h-{}z", column, row, end - column, end - column);
      column = end;
    }
  }
  return paths;
}

}  // namespace landfix::tools
