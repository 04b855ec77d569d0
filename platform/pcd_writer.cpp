#include "platform/pcd_writer.hpp"

#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"

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

}  // namespace

void write_pcd_records(const std::filesystem::path& path, std::span<const PcdMember> members,
                       std::span<const std::byte> records, std::size_t record_size) {
  const std::size_t points = records.size() / record_size;
  std::size_t point_size = 0;
  for (const PcdMember& member : members) point_size += member.size;
  std::vector<std::byte> packed(points * point_size);
  std::byte* to = packed.data();
  for (std::size_t i = 0; i < points; ++i) {
    for (const PcdMember& member : members) {
      std::memcpy(to, &records[i * record_size + member.offset], member.size);
      to += member.size;
    }
  }
  AtomicFile file(path);
  file.write(header(members, points));
  file.write(packed);
  file.commit();
}

}  // namespace landfix::platform
