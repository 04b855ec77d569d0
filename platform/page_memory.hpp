// Memory that is there: whole pages, large ones where the system has them, touched before it is used.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace landfix::platform {

struct UnmapPages {
  std::size_t size = 0;
  void operator()(std::byte* bytes) const noexcept;
};

class PageMemory {
 public:
  /// Throws std::runtime_error where it cannot be had.
  explicit PageMemory(std::size_t size);

  [[nodiscard]] std::span<std::byte> bytes() const noexcept {
    return {bytes_.get(), bytes_.get_deleter().size};
  }

 private:
  std::unique_ptr<std::byte[], UnmapPages> bytes_;
};

}  // namespace landfix::platform
