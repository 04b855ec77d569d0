// The memory that a map lives in.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace landfix::ndt {

/// Bytes to make a map image in, 0, aligned for VoxelMap.
class MapMemory {
 public:
  /// Throws std::runtime_error where the memory cannot be had.
  explicit MapMemory(std::size_t size);

  [[nodiscard]] std::span<std::byte> bytes() noexcept { return {bytes_.get(), size_}; }
  [[nodiscard]] std::shared_ptr<const void> owner() const noexcept { return bytes_; }

 private:
  std::shared_ptr<std::byte> bytes_;
  std::size_t size_;
};

/// A finished map image and what keeps its bytes where they are: memory of its own, or a mapped file. Copies
/// share them.
class MapImage {
 public:
  MapImage() = default;
  explicit MapImage(MapMemory memory) noexcept : MapImage(memory.bytes(), memory.owner()) {}
  MapImage(std::span<const std::byte> bytes, std::shared_ptr<const void> owner) noexcept
      : owner_(std::move(owner)), bytes_(bytes) {}

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::shared_ptr<const void> owner_;
  std::span<const std::byte> bytes_;
};

}  // namespace landfix::ndt
