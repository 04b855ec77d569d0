// Ouster's lidar packets of any profile, and metadata to go with them, for tests and benchmarks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "drivers/ouster/crc64.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/ouster/wire.hpp"

namespace landfix::test {

/// Rows from +20 deg down to -20 deg, azimuths in the usual pattern, beams that start 15.806 mm off the axis.
[[nodiscard]] inline drivers::ouster::Metadata ouster_metadata(drivers::ouster::Profile profile,
                                                               std::size_t rows = 64,
                                                               std::size_t columns_per_frame = 1024) {
  constexpr double kAzimuthsDeg[] = {4.2, 1.4, -1.4, -4.2};
  drivers::ouster::Metadata metadata{.profile = profile, .row_count = rows, .beam_count = rows};
  for (std::size_t i = 0; i < rows; ++i) {
    metadata.rows[i] = {.altitude_deg = 20.0 - 40.0 * static_cast<double>(i) / static_cast<double>(rows - 1),
                        .azimuth_deg = kAzimuthsDeg[i % 4],
                        .ring = static_cast<std::uint16_t>(rows - 1 - i),
                        .present = true};
  }
  if (profile == drivers::ouster::Profile::low_rate_dual_fusa) {
    metadata.header_type = drivers::ouster::HeaderType::fusa;
  }
  metadata.columns_per_frame = columns_per_frame;
  metadata.window = {.first = 0, .last = columns_per_frame - 1};
  metadata.beam_origin_x_mm = 15.806;
  return metadata;
}

/// Sound and empty: every field can be set.
class OusterPacket {
 public:
  static constexpr std::int64_t kColumnNs = 97'656;  // 1024 columns, 10 turns a second

  explicit OusterPacket(const drivers::ouster::Metadata& metadata)
      : legacy_(metadata.profile == drivers::ouster::Profile::legacy),
        header_type_(metadata.header_type),
        pixel_(drivers::ouster::pixel_of(metadata.profile)),
        shape_(
            drivers::ouster::packet_shape(metadata.profile, metadata.row_count, metadata.columns_per_packet)),
        bytes_(shape_.packet_bytes) {
    if (!legacy_) set(0, 1, header_type_ == drivers::ouster::HeaderType::fusa ? 1 : 2);
    for (std::size_t i = 0; i < shape_.columns; ++i) set_valid(i, true);
  }

  void set(std::size_t at, std::uint64_t value, std::size_t size) {
    std::memcpy(bytes_.data() + at, &value, size);
  }
  void set_frame(std::uint32_t id) {
    for (std::size_t i = 0; legacy_ && i < shape_.columns; ++i) set(column_at(i) + 10, id, 2);
    if (legacy_) return;
    header_type_ == drivers::ouster::HeaderType::fusa ? set(4, id, 4) : set(2, id, 2);
  }
  void set_init_id(std::uint32_t id) {
    set(header_type_ == drivers::ouster::HeaderType::fusa ? 1 : 4, id, 3);
  }
  void set_serial_number(std::uint64_t number) {
    set(header_type_ == drivers::ouster::HeaderType::fusa ? 11 : 7, number, 5);
  }
  void set_time(std::size_t column, std::uint64_t ns) { set(column_at(column), ns, 8); }
  void set_column_id(std::size_t column, unsigned id) { set(column_at(column) + 8, id, 2); }
  void set_valid(std::size_t column, bool valid) {
    if (legacy_) {
      set(column_at(column + 1) - 4, valid ? 0xFFFF'FFFF : 0, 4);
    } else {
      set(column_at(column) + 10, valid ? 1 : 0, 2);
    }
  }
  /// Packet `number` of its frame, the first column at this time.
  void set_place(std::size_t number, std::int64_t first_ns, std::int64_t column_ns = kColumnNs) {
    for (std::size_t i = 0; i < shape_.columns; ++i) {
      set_time(i, static_cast<std::uint64_t>(first_ns + static_cast<std::int64_t>(i) * column_ns));
      set_column_id(i, static_cast<unsigned>(number * shape_.columns + i));
    }
  }
  /// In the units of the wire; `k` 1 is the second return.
  void set_return(std::size_t column, std::size_t row, unsigned range_raw, unsigned reflectivity = 0,
                  std::size_t k = 0) {
    const std::size_t at = pixel_at(column, row) + k * pixel_.second_at;
    std::uint32_t word = 0;
    std::memcpy(&word, bytes_.data() + at, sizeof(word));
    set(at, (word & ~pixel_.range_mask) | range_raw, sizeof(word));
    set(at + pixel_.reflectivity_at, reflectivity, 1);
  }
  void set_crc() {
    const auto body = std::span(bytes_).first(bytes_.size() - 8);
    set(body.size(), drivers::ouster::crc64(body), 8);
  }

  [[nodiscard]] std::size_t column_at(std::size_t column) const {
    return shape_.first_column_at + column * shape_.column_bytes;
  }
  [[nodiscard]] std::size_t pixel_at(std::size_t column, std::size_t row) const {
    return column_at(column) + shape_.first_pixel_at + row * pixel_.bytes;
  }
  [[nodiscard]] std::span<std::byte> bytes() { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  bool legacy_;
  drivers::ouster::HeaderType header_type_;
  drivers::ouster::PixelLayout pixel_;
  drivers::ouster::PacketShape shape_;
  std::vector<std::byte> bytes_;
};

}  // namespace landfix::test
