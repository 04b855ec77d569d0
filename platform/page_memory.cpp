#include "platform/page_memory.hpp"

#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/mman.h>

namespace landfix::platform {

void UnmapPages::operator()(std::byte* bytes) const noexcept { ::munmap(bytes, size); }

PageMemory::PageMemory(std::size_t size) {
  void* const address = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (address == MAP_FAILED) throw std::runtime_error(fmt::format("no memory for {} bytes", size));
  bytes_ = std::unique_ptr<std::byte[], UnmapPages>(static_cast<std::byte*>(address), UnmapPages{size});
  ::madvise(address, size, MADV_HUGEPAGE);
  std::memset(address, 0, size);
}

}  // namespace landfix::platform
