#include "platform/pcd_writer.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace landfix::platform {
namespace {

/// As long for any number of points.
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
      "WIDTH {:010}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {:010}\nDATA binary\n",
      fields, sizes, types, counts, points, points);
}

std::size_t point_bytes(std::span<const PcdMember> members) {
  std::size_t sum = 0;
  for (const PcdMember& member : members) sum += member.size;
  return sum;
}

}  // namespace

PcdStream::PcdStream(const std::filesystem::path& path, std::span<const PcdMember> members)
    : file_(path), members_(members) {
  file_.write(header(members_, 0));
}

void PcdStream::write(std::span<const std::byte> packed) {
  bytes_ += packed.size();
  file_.write(packed);
}

void PcdStream::commit() {
  const std::size_t size = point_bytes(members_);
  if (bytes_ % size != 0) throw std::logic_error("the last point of a cloud is not whole");
  file_.overwrite_start(header(members_, bytes_ / size));
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
  PcdStream cloud(path, members);
  cloud.write(packed);
  cloud.commit();
}

}  // namespace landfix::platform
