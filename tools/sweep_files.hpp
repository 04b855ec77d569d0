// Decoded sweeps as files, one a sweep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "drivers/sweep.hpp"

namespace landfix::tools {

enum class SweepFormat : std::uint8_t { pcd, csv };

/// Writes 0000.pcd (or .csv) and on.
class SweepFiles {
 public:
  /// Makes the folder if it is missing. Throws std::filesystem::filesystem_error.
  SweepFiles(std::filesystem::path folder, SweepFormat format);

  /// Throws std::runtime_error where the file cannot be written.
  void write(const drivers::Sweep& sweep);

  /// Files of the same kind that an earlier run left behind the last one written: who reads the whole folder
  /// would take them for the same drive.
  [[nodiscard]] std::size_t left_over() const;

 private:
  [[nodiscard]] std::filesystem::path path_of(std::size_t index) const;

  std::filesystem::path folder_;
  SweepFormat format_;
  std::size_t written_ = 0;
};

}  // namespace landfix::tools
