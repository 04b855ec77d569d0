#include "drivers/ouster/recognise.hpp"

#include <algorithm>

namespace landfix::drivers::ouster {
namespace {

/// One after the other in number and in time, from a multiple of their count on.
bool has_columns(std::span<const std::byte> payload, const PacketShape& shape, bool legacy) noexcept {
  ColumnHeader last;
  for (std::size_t i = 0; i < shape.columns; ++i) {
    const ColumnHeader column =
        read_column(payload.data() + shape.first_column_at + i * shape.column_bytes, shape, legacy);
    if (i == 0 && column.id % shape.columns != 0) return false;
    if (column.id >= kMaxColumnsPerFrame) return false;
    if (i > 0 && (column.id != last.id + 1 || column.time_ns <= last.time_ns)) return false;
    if (i > 0 && column.frame_id != last.frame_id) return false;
    last = column;
  }
  return true;
}

/// The encoder counts what the column's number says, for one of the modes' numbers of columns.
bool has_encoder(std::span<const std::byte> payload, const PacketShape& shape) noexcept {
  const auto encoder = [&](std::size_t i) {
    return load_little_endian<std::uint32_t>(payload.data() + i * shape.column_bytes + 12);
  };
  const std::uint32_t ticks = encoder(1) - encoder(0);
  const bool known = ticks == kEncoderTicks / 512 || ticks == kEncoderTicks / 1024 ||
                     ticks == kEncoderTicks / 2048 || ticks == kEncoderTicks / 4096;
  if (!known) return false;
  for (std::size_t i = 0; i < shape.columns; ++i) {
    const std::byte* const column = payload.data() + i * shape.column_bytes;
    if (encoder(i) != load_little_endian<std::uint16_t>(column + 8) * ticks) return false;
    const auto status = load_little_endian<std::uint32_t>(column + shape.column_bytes - kLegacyStatusBytes);
    if (status != 0 && status != 0xFFFF'FFFF) return false;
  }
  return true;
}

bool is_legacy(std::span<const std::byte> payload, std::size_t rows) noexcept {
  const PacketShape shape = packet_shape(Profile::legacy, rows, kColumnsPerPacket);
  return payload.size() == shape.packet_bytes && has_columns(payload, shape, true) &&
         has_encoder(payload, shape);
}

bool has_header_and_footer(std::span<const std::byte> payload) noexcept {
  constexpr auto kLidar = static_cast<std::uint32_t>(PacketType::lidar);
  // The FUSA header's type is one byte, and bytes of the init id follow.
  if (read_header(payload.data(), HeaderType::fusa).type != kLidar) return false;
  const auto reserved = payload.last(kFooterBytes).first(kFooterBytes - kCrcBytes);
  return std::ranges::all_of(reserved, [](std::byte byte) { return byte == std::byte{0}; });
}

}  // namespace

bool recognise(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  const std::size_t rows = model.beam_count;
  if (is_legacy(payload, rows)) return true;
  if (rows < kRowsOfOldFirmware && is_legacy(payload, kRowsOfOldFirmware)) return true;
  for (std::size_t i = 1; i < kProfiles.size(); ++i) {
    const PacketShape shape = packet_shape(static_cast<Profile>(i), rows, kColumnsPerPacket);
    if (payload.size() != shape.packet_bytes) continue;
    if (has_header_and_footer(payload) && has_columns(payload, shape, false)) return true;
  }
  return false;
}

}  // namespace landfix::drivers::ouster
