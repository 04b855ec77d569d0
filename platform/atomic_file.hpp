// Files that are whole or absent: written to a temporary name beside the target, renamed when finished.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace landfix::platform {

/// Throws std::runtime_error with the path and the system's reason where anything fails. Allocates in the
/// constructor alone.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  /// Without `commit` nothing is left behind.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// In place of what was written first, of which there is as much.
  void overwrite_start(std::string_view text);
  /// Flushes, syncs to disk and gives the file its name.
  void commit();

  [[nodiscard]] const std::filesystem::path& temporary_path() const noexcept { return temporary_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::unique_ptr<char[]> buffer_;
  std::FILE* file_ = nullptr;
  bool has_its_name_ = false;
};

/// The whole file. Throws std::runtime_error with the path and the reason.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& path);

/// All of a file at once.
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace landfix::platform
