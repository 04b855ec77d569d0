#include "platform/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "platform/file_error.hpp"

namespace landfix::platform {

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(path_.string() + ".part" + std::to_string(::getpid())) {
  // A rename would put a plain file in the place of a device, a pipe or a link.
  if (std::filesystem::exists(path_) &&
      !std::filesystem::is_regular_file(std::filesystem::symlink_status(path_))) {
    throw std::runtime_error(
        fmt::format("{}: is there and not a plain file; choose another name", path_.string()));
  }
  file_ = std::fopen(temporary_.c_str(), "wbe");
  if (file_ == nullptr) fail(path_, "create it");
  constexpr std::size_t kBufferBytes = 1 << 16;
  buffer_ = std::make_unique<char[]>(kBufferBytes);
  std::setvbuf(file_, buffer_.get(), _IOFBF, kBufferBytes);
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (has_its_name_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(path_, "write");
}

void AtomicFile::overwrite_start(std::string_view text) {
  if (std::fseek(file_, 0, SEEK_SET) != 0) fail(path_, "write");
  write(text);
  if (std::fseek(file_, 0, SEEK_END) != 0) fail(path_, "write");
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void AtomicFile::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail(path_, "write");
  const int closed = std::fclose(std::exchange(file_, nullptr));
  if (closed != 0) fail(path_, "close");
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "rename the finished file to");
  has_its_name_ = true;
}

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rbe"), close);
  if (!file) fail(path, "open");
  std::vector<std::byte> bytes;
  std::error_code no_size;
  const auto size = std::filesystem::file_size(path, no_size);
  constexpr std::size_t kChunk = 1 << 20;
  if (!no_size) bytes.reserve(size + kChunk);  // with room for the chunk that finds the end
  for (;;) {
    const std::size_t old_size = bytes.size();
    bytes.resize(old_size + kChunk);
    const std::size_t got = std::fread(bytes.data() + old_size, 1, kChunk, file.get());
    bytes.resize(old_size + got);
    if (got < kChunk) break;
  }
  if (std::ferror(file.get()) != 0) fail(path, "read");
  return bytes;
}

}  // namespace landfix::platform
