// The memory that a map lives in.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace landfix::ndt {

/// The bytes of a map image, aligned for VoxelMap.
class MapImage {
 public:
  MapImage() = default;
  explicit MapImage(std::size_t size);

  [[nodiscard]] std::span<std::byte> bytes() noexcept { return {bytes_.get(), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {bytes_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::byte* bytes) const noexcept;
  };
  std::unique_ptr<std::byte[], Free> bytes_;
  std::size_t size_ = 0;
};

}  // namespace landfix::ndt
