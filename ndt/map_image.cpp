#include "ndt/map_image.hpp"

#include <cstring>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "ndt/map_layout.hpp"

namespace landfix::ndt {

MapMemory::MapMemory(std::size_t size) : size_(size) {
  constexpr std::align_val_t kAlignment{alignof(Voxel)};
  auto* const bytes = static_cast<std::byte*>(::operator new[](size, kAlignment, std::nothrow));
  if (bytes == nullptr) throw std::runtime_error(fmt::format("no memory for a map of {} bytes", size));
  bytes_.reset(bytes, [](std::byte* memory) { ::operator delete[](memory, kAlignment); });
  std::memset(bytes, 0, size);
}

}  // namespace landfix::ndt
