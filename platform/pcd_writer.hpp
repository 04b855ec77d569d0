// Writes binary PCD 0.7 files from records of any plain struct, described by a table of fields.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <type_traits>

#include "drivers/point.hpp"
#include "platform/atomic_file.hpp"

namespace landfix::platform {

/// A member of the record and what it is called in the file.
struct PcdMember {
  std::string_view name;
  char type = 'F';         ///< F float, I signed, U unsigned
  std::uint8_t size = 4;   ///< bytes
  std::size_t offset = 0;  ///< in the record
};

/// A cloud too large for the memory, whose points come one by one. Throws std::runtime_error with the path
/// and the reason.
class PcdStream {
 public:
  /// `members` must outlive it.
  PcdStream(const std::filesystem::path& path, std::span<const PcdMember> members);
  /// One point or several: their members in order, without gaps.
  void write(std::span<const std::byte> packed);
  /// Throws std::logic_error if the last point is not whole.
  void commit();

 private:
  AtomicFile file_;
  std::span<const PcdMember> members_;
  std::uint64_t bytes_ = 0;  ///< of points
};

/// `records`: whole records of `record_size` bytes. Throws std::runtime_error with the path and the reason.
void write_pcd_records(const std::filesystem::path& path, std::span<const PcdMember> members,
                       std::span<const std::byte> records, std::size_t record_size);

template <class Record>
void write_pcd(const std::filesystem::path& path, std::span<const PcdMember> members,
               std::span<const Record> records) {
  static_assert(std::is_trivially_copyable_v<Record> && std::is_standard_layout_v<Record>);
  write_pcd_records(path, members, std::as_bytes(records), sizeof(Record));
}

/// The fields of a decoded sweep.
inline constexpr std::array kPointMembers = {
    PcdMember{.name = "x", .offset = offsetof(drivers::Point, x)},
    PcdMember{.name = "y", .offset = offsetof(drivers::Point, y)},
    PcdMember{.name = "z", .offset = offsetof(drivers::Point, z)},
    PcdMember{.name = "intensity", .offset = offsetof(drivers::Point, intensity)},
    PcdMember{.name = "ring", .type = 'U', .size = 2, .offset = offsetof(drivers::Point, ring)},
    PcdMember{.name = "time", .offset = offsetof(drivers::Point, time_s)},
};

/// Three floats in a row.
inline constexpr std::array kPositionMembers = {
    PcdMember{.name = "x", .offset = 0},
    PcdMember{.name = "y", .offset = sizeof(float)},
    PcdMember{.name = "z", .offset = 2 * sizeof(float)},
};

}  // namespace landfix::platform
