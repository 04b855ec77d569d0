#include "ndt/map_image.hpp"

#include <cstring>
#include <new>

#include "ndt/voxel_map.hpp"

namespace landfix::ndt {
namespace {

constexpr std::size_t kAlignment = alignof(Voxel);

}  // namespace

void MapImage::Free::operator()(std::byte* bytes) const noexcept {
  ::operator delete[](bytes, std::align_val_t{kAlignment});
}

MapImage::MapImage(std::size_t size)
    : bytes_(static_cast<std::byte*>(::operator new[](size, std::align_val_t{kAlignment}))), size_(size) {
  std::memset(bytes_.get(), 0, size);
}

}  // namespace landfix::ndt
