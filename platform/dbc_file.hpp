// What a DBC file says of the frames of a bus: their identifiers, and where their signals are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "platform/vehicle_signal.hpp"

namespace landfix::platform {

struct DbcSignal {
  std::string name;
  RawField field;
  double scale = 1.0;
  double offset = 0.0;
  std::string unit;
  bool multiplexed = false;  ///< in the frame only at times, which another signal tells
  std::size_t line = 0;
};

struct DbcMessage {
  std::string name;
  std::uint32_t id = 0;
  bool extended = false;
  std::size_t bytes = 0;
  std::vector<DbcSignal> signals;
};

/// Messages and their signals; all else in the file is left out. Throws std::runtime_error with path, line,
/// and what is wrong.
[[nodiscard]] std::vector<DbcMessage> parse_dbc(std::string_view text, const std::filesystem::path& path);
[[nodiscard]] std::vector<DbcMessage> read_dbc(const std::filesystem::path& path);

}  // namespace landfix::platform
