// A file as memory: its pages are the page cache's own, so that nothing is copied and they can be given back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace landfix::platform {

/// Read-only. What another program changes in the file while it is mapped is seen, and reading beyond a new
/// end is a SIGBUS: who replaces a file must rename a new one to its name, as AtomicFile does.
class MappedFile {
 public:
  /// What is no plain file (a pipe, say) is read instead. Throws std::runtime_error with the path and the
  /// reason.
  explicit MappedFile(std::filesystem::path path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
  /// Whether the bytes begin on a page.
  [[nodiscard]] bool is_mapped() const noexcept { return is_mapped_; }

  /// Brings in every page, so that reading does not fault unless memory runs short; mlockall keeps them in.
  /// Throws std::runtime_error where the file has become shorter than it was when it was mapped.
  void populate() const;
  /// Gives the pages back: they come again when they are read. For files that are read once and are larger
  /// than memory.
  void drop_pages() const noexcept;

 private:
  std::filesystem::path path_;
  std::span<const std::byte> bytes_;
  std::vector<std::byte> read_;
  bool is_mapped_ = false;
};

}  // namespace landfix::platform
