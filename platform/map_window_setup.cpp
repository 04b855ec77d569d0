#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ndt/lattice.hpp"
#include "platform/map_window.hpp"

namespace landfix::platform {
namespace {

/// A window reaches so many tiles beyond what the sensor sees: one that the vehicle moves before the next
/// window is loaded, and one that it moves meanwhile (at 1 m, 16 m: half a second at 115 km/h).
constexpr double kTilesBeyondReach = 2.0;
constexpr double kReloadAfterTiles = 1.0;
constexpr std::size_t kSmallestImage = 1 << 14;

/// An open file that is read at any place.
class RandomAccessFile {
 public:
  explicit RandomAccessFile(const std::filesystem::path& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status {};
    if (number_ < 0 || ::fstat(number_, &status) != 0) {
      throw std::runtime_error(fmt::format("{}: cannot open: {}", path.string(), std::strerror(errno)));
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }
  ~RandomAccessFile() {
    if (number_ >= 0) ::close(number_);
  }
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] bool read_at(std::uint64_t offset, std::span<std::byte> into) const noexcept {
    while (!into.empty()) {
      const ssize_t got = ::pread(number_, into.data(), into.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      into = into.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    }
    return true;
  }

 private:
  int number_;
  std::uint64_t size_ = 0;
};

[[nodiscard]] ndt::WindowAssembler assembler_of(const std::filesystem::path& path, double reach_m) {
  const auto file = std::make_shared<const RandomAccessFile>(path);
  const ndt::ReadAt read_at = [file](std::uint64_t offset, std::span<std::byte> into) {
    return file->read_at(offset, into);
  };
  ndt::MapDirectory directory = ndt::read_map_directory(read_at, file->size(), path.string());
  const double tile_m = ndt::kTileCells * directory.header.resolution_m;
  return {std::move(directory), read_at, reach_m + kTilesBeyondReach * tile_m};
}

[[nodiscard]] std::size_t image_bytes(std::size_t memory_bytes) {
  return std::max(memory_bytes / 2, kSmallestImage);
}

}  // namespace

MapWindow::MapWindow(const std::filesystem::path& path, const MapWindowSettings& settings,
                     const std::optional<Eigen::Vector3d>& start_m)
    : assembler_(assembler_of(path, settings.reach_m)),
      start_m_(start_m ? *start_m : assembler_.map_middle_m()),
      reload_after_m_(kReloadAfterTiles * ndt::kTileCells * assembler_.map_header().resolution_m),
      images_{PageMemory(image_bytes(settings.memory_bytes)),
              PageMemory(image_bytes(settings.memory_bytes))} {
  load_around(start_m_, *hand_over_.writable());
  (void)newest(start_m_);
}

bool MapWindow::load() {
  const Eigen::Vector3d place_m = middle_of(place_.load(std::memory_order_relaxed));
  if ((place_m - loaded_around_m_).head<2>().norm() < reload_after_m_) return false;
  const auto image = hand_over_.writable();
  if (image) load_around(place_m, *image);
  return image.has_value();
}

void MapWindow::load_around(const Eigen::Vector3d& centre_m, std::size_t image) {
  const ndt::WindowContent content = assembler_.assemble(images_[image].bytes(), centre_m);
  loaded_around_m_ = centre_m;
  windows_.fetch_add(1, std::memory_order_relaxed);
  tiles_not_fitting_.fetch_add(content.tiles_not_fitting, std::memory_order_relaxed);
  tiles_unreadable_.fetch_add(content.tiles_unreadable, std::memory_order_relaxed);
  hand_over_.publish();
}

Eigen::Vector3d MapWindow::middle_of(std::uint64_t block) const noexcept {
  const ndt::Cell corner = ndt::block_corner(block);
  return resolution_m() * Eigen::Vector3d(corner.i + 2, corner.j + 2, corner.k + 2);
}

MapWindowCounters MapWindow::counters() const noexcept {
  return {.windows = windows_.load(std::memory_order_relaxed),
          .tiles_not_fitting = tiles_not_fitting_.load(std::memory_order_relaxed),
          .tiles_unreadable = tiles_unreadable_.load(std::memory_order_relaxed)};
}

}  // namespace landfix::platform
