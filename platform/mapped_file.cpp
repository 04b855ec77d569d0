#include "platform/mapped_file.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "platform/atomic_file.hpp"
#include "platform/file_error.hpp"

namespace landfix::platform {
namespace {

/// A descriptor for as long as it takes to map it.
struct Descriptor {
  int number;
  explicit Descriptor(int opened) noexcept : number(opened) {}
  ~Descriptor() { ::close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

[[nodiscard]] void* address_of(std::span<const std::byte> bytes) noexcept {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): as mmap gave it
  return const_cast<std::byte*>(bytes.data());
}

}  // namespace

MappedFile::MappedFile(std::filesystem::path path) : path_(std::move(path)) {
  const int number = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (number < 0) fail(path_, "open");
  const Descriptor file{number};
  struct stat status {};
  if (::fstat(file.number, &status) != 0) fail(path_, "open");
  if (!S_ISREG(status.st_mode)) {
    read_ = read_file(path_);
    bytes_ = read_;
    return;
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return;
  void* const address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number, 0);
  if (address == MAP_FAILED) fail(path_, "map it into memory");
  bytes_ = {static_cast<const std::byte*>(address), size};
  is_mapped_ = true;
}

MappedFile::~MappedFile() {
  if (is_mapped_) ::munmap(address_of(bytes_), bytes_.size());
}

void MappedFile::populate() const {
  if (!is_mapped_) return;
  // Unlike MAP_POPULATE it says where it fails. Kernels before 5.14 do not know it: there the first read
  // faults.
  if (::madvise(address_of(bytes_), bytes_.size(), MADV_POPULATE_READ) == 0 || errno == EINVAL) return;
  if (errno == EFAULT) {
    throw std::runtime_error(
        fmt::format("{}: it became shorter than its {} bytes while it was opened; copy or "
                    "build it again",
                    path_.string(), bytes_.size()));
  }
  fail(path_, "read");
}

void MappedFile::drop_pages() const noexcept {
  if (is_mapped_) ::madvise(address_of(bytes_), bytes_.size(), MADV_DONTNEED);
}

}  // namespace landfix::platform
