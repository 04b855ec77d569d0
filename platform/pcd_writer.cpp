#include "platform/pcd_writer.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace landfix::platform {
namespace {

std::string header(std::span<const PcdMember> members, std::size_t points) {
  std::string fields;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const PcdMember& member : members) {
    fields += fmt::format(" {}", member.name);
    sizes += fmt::format(" {}", member.size);
    types += fmt::format(" {}", member.type);
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      fields, sizes, types, counts, points, points);
}

std::size_t point_bytes(std::span<const PcdMember> members) {
  std::size_t sum = 0;
  for (const PcdMember& member : members) sum += member.size;
  return sum;
}

}  // namespace

PcdStream::PcdStream(const std::filesystem::path& path, std::span<const PcdMember> members,
                     std::size_t points)
    : file_(path), bytes_left_(points * point_bytes(members)) {
  file_.write(header(members, points));
}

void PcdStream::write(std::span<const std::byte> packed) {
  if (packed.size() > bytes_left_) throw std::logic_error("a point cloud has more points than announced");
  bytes_left_ -= packed.size();
  file_.write(packed);
}

void PcdStream::commit() {
  if (bytes_left_ != 0) throw std::logic_error("a point cloud has fewer points than announced");
  file_.commit();
}

void write_pcd_records(const std::filesystem::path& path, std::span<const PcdMember> members,
                       std::span<const std::byte> records, std::size_t record_size) {
  const std::size_t points = records.size() / record_size;
  std::vector<std::byte> packed(points * point_bytes(members));
  std::byte* to = packed.data();
  for (std::size_t i = 0; i < points; ++i) {
    for (const PcdMember& member : members) {
      std::memcpy(to, &records[i * record_size + member.offset], member.size);
      to += member.size;
    }
  }
  PcdStream cloud(path, members, points);
  cloud.write(packed);
  cloud.commit();
}

}  // namespace landfix::platform
