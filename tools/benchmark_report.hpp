// What `landfix benchmark` prints.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/benchmark_run.hpp"

namespace landfix::tools {

struct BenchmarkReport {
  BenchmarkResult result;
  std::size_t map_voxels = 0;
  std::size_t map_bytes = 0;
  std::optional<double> map_read_ms;      ///< of a point cloud
  std::optional<std::string> rival_name;  ///< nothing where there was none
};

[[nodiscard]] nlohmann::json to_json(const BenchmarkReport& report);
[[nodiscard]] std::string to_text(const BenchmarkReport& report);

}  // namespace landfix::tools
