#include "tools/sweep_files.hpp"

#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "platform/pcd_writer.hpp"

namespace landfix::tools {
namespace {

void write_csv(const std::filesystem::path& path, std::span<const drivers::Point> points) {
  std::string text = "x,y,z,intensity,ring,time\n";
  for (const drivers::Point& point : points) {
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:g},{},{:.9f}\n", point.x, point.y, point.z, point.intensity,
                        point.ring, point.time_s);
  }
  platform::AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

SweepFiles::SweepFiles(std::filesystem::path folder, SweepFormat format)
    : folder_(std::move(folder)), format_(format) {
  std::filesystem::create_directories(folder_);
}

std::filesystem::path SweepFiles::path_of(std::size_t index) const {
  return folder_ / fmt::format("{:04}.{}", index, format_ == SweepFormat::pcd ? "pcd" : "csv");
}

void SweepFiles::write(const drivers::Sweep& sweep) {
  const std::filesystem::path path = path_of(written_++);
  if (format_ == SweepFormat::pcd) {
    platform::write_pcd(path, platform::kPointMembers, sweep.points());
  } else {
    write_csv(path, sweep.points());
  }
}

std::size_t SweepFiles::left_over() const {
  std::size_t count = 0;
  while (std::filesystem::exists(path_of(written_ + count))) ++count;
  return count;
}

}  // namespace landfix::tools
