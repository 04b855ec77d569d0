#include "tools/autoware_tiles.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace landfix::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& metadata, const YAML::Mark& mark,
                       const std::string& why) {
  // An empty file has no lines to point at.
  if (mark.is_null()) throw std::runtime_error(fmt::format("{}: {}", metadata.string(), why));
  throw std::runtime_error(
      fmt::format("{}:{}:{}: {}", metadata.string(), mark.line + 1, mark.column + 1, why));
}

[[nodiscard]] bool is_number(const YAML::Node& node) {
  return node.IsScalar() && std::isfinite(node.as<double>(std::nan("")));
}

[[nodiscard]] std::optional<std::filesystem::path> find_tile(const std::filesystem::path& folder,
                                                             const std::string& name) {
  for (const char* const place : {"", "pointcloud_map", "pointcloud_map.pcd"}) {
    std::filesystem::path tile = folder / place / name;
    if (std::filesystem::is_regular_file(tile)) return tile;
  }
  return std::nullopt;
}

[[nodiscard]] YAML::Node load(const std::filesystem::path& metadata) {
  try {
    return YAML::LoadFile(metadata.string());
  } catch (const YAML::ParserException& error) {
    fail(metadata, error.mark, error.msg);
  } catch (const YAML::Exception&) {
    throw std::runtime_error(fmt::format("{}: cannot read it", metadata.string()));
  }
}

}  // namespace

std::vector<std::filesystem::path> list_tiles(const std::filesystem::path& metadata) {
  const YAML::Node root = load(metadata);
  if (!root.IsMap())
    fail(metadata, root.Mark(), "expected x_resolution, y_resolution and a line for each tile");
  for (const char* const key : {"x_resolution", "y_resolution"}) {
    if (!root[key]) fail(metadata, root.Mark(), fmt::format("no {}", key));
    if (!is_number(root[key]) || root[key].as<double>() <= 0.0)
      fail(metadata, root[key].Mark(), fmt::format("{} is not a positive length", key));
  }
  std::vector<std::filesystem::path> tiles;
  for (const auto& entry : root) {
    const auto name = entry.first.as<std::string>();
    if (name == "x_resolution" || name == "y_resolution") continue;
    const YAML::Node& corner = entry.second;
    if (!corner.IsSequence() || corner.size() != 2 || !is_number(corner[0]) || !is_number(corner[1]))
      fail(metadata, entry.first.Mark(), fmt::format("tile {}: its corner is not [x, y]", name));
    const auto tile = find_tile(metadata.parent_path(), name);
    if (!tile) {
      fail(metadata, entry.first.Mark(),
           fmt::format("tile {} is missing: neither beside this file nor in pointcloud_map", name));
    }
    tiles.push_back(*tile);
  }
  if (tiles.empty()) fail(metadata, root.Mark(), "it lists no tile");
  return tiles;
}

}  // namespace landfix::tools
