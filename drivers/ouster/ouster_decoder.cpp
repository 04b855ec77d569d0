#include "drivers/ouster/ouster_decoder.hpp"

#include <algorithm>

#include "drivers/ouster/crc64.hpp"

namespace landfix::drivers::ouster {
namespace {

/// What firmware 2.3 and 2.4 sends for want of a checksum: DE C0 00 00 EF BE AD DE.
constexpr std::uint64_t kNoCrc = 0xDEAD'BEEF'0000'C0DE;
/// Columns are 0.05 ms to 0.2 ms apart; a clock that is set makes more of it.
constexpr std::int64_t kLongestStepNs = 10'000'000;

/// Zero (firmware 2.2) or a constant (2.3, 2.4) stand for a checksum that there is not.
bool checksum_fits(std::span<const std::byte> payload) noexcept {
  const auto sent = load_little_endian<std::uint64_t>(payload.data() + payload.size() - kCrcBytes);
  return sent == 0 || sent == kNoCrc || sent == crc64(payload.first(payload.size() - kCrcBytes));
}

}  // namespace

OusterDecoder::OusterDecoder(const Metadata& metadata, const DecoderOptions& options) noexcept
    : legacy_(metadata.profile == Profile::legacy),
      header_type_(metadata.header_type),
      shape_(packet_shape(metadata.profile, metadata.row_count, metadata.columns_per_packet)),
      columns_per_frame_(metadata.columns_per_frame),
      window_(metadata.window),
      serial_number_(metadata.serial_number),
      projector_(metadata, options),
      cutter_(metadata) {}

DecodeStatus OusterDecoder::validate_frame(std::span<const std::byte> payload,
                                           Header& header) const noexcept {
  if (legacy_) {
    header.frame_id = read_column(payload.data(), shape_, legacy_).frame_id;
    return DecodeStatus::decoded;
  }
  const PacketHeader packet = read_header(payload.data(), header_type_);
  if (packet.type != static_cast<std::uint32_t>(PacketType::lidar)) return DecodeStatus::wrong_header;
  // Its beams would be another unit's.
  const bool named = packet.serial_number != 0 && serial_number_ != 0;
  if (named && packet.serial_number != serial_number_) return DecodeStatus::wrong_model;
  // Firmware with the FUSA header leaves the checksum out.
  if (header_type_ == HeaderType::standard && !checksum_fits(payload)) return DecodeStatus::wrong_checksum;
  header.frame_id = packet.frame_id;
  header.init_id = packet.init_id;
  return DecodeStatus::decoded;
}

DecodeStatus OusterDecoder::validate_columns(std::span<const std::byte> payload,
                                             Header& header) const noexcept {
  const std::byte* column = payload.data() + shape_.first_column_at;
  std::int64_t last_ns = 0;
  for (std::size_t i = 0; i < shape_.columns; ++i, column += shape_.column_bytes) {
    const ColumnHeader read = read_column(column, shape_, legacy_);
    if (i == 0) header.first_column = read.id;
    if (read.id != header.first_column + i) return DecodeStatus::wrong_header;
    if (legacy_ && read.frame_id != header.frame_id) return DecodeStatus::wrong_header;
    header.valid[i] = read.valid && window_.contains(read.id);
    if (!header.valid[i]) continue;
    if (read.time_ns > static_cast<std::uint64_t>(SensorClock::kLatestNs)) return DecodeStatus::wrong_time;
    const auto time_ns = static_cast<std::int64_t>(read.time_ns);
    if (!header.first_firing_ns) {
      header.first_firing_ns = time_ns;
    } else if (time_ns <= last_ns || time_ns - last_ns > kLongestStepNs) {
      return DecodeStatus::wrong_time;
    }
    header.firing_ns[i] = last_ns = time_ns;
  }
  const bool in_place = header.first_column % shape_.columns == 0 &&
                        header.first_column + shape_.columns <= columns_per_frame_ &&
                        cutter_.expects(header.first_column / shape_.columns);
  return in_place ? DecodeStatus::decoded : DecodeStatus::wrong_header;
}

DecodeResult OusterDecoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  // LEGACY names no packet type: there the size decides first.
  const bool fits = packet.payload.size() == shape_.packet_bytes;
  if (!(fits && legacy_) && is_telemetry(packet.payload, header_type_)) {
    return {.status = DecodeStatus::telemetry};
  }
  if (!fits) return {.status = DecodeStatus::wrong_size};
  Header header;
  if (const auto status = validate_frame(packet.payload, header); status != DecodeStatus::decoded) {
    return {.status = status};
  }
  if (const auto status = validate_columns(packet.payload, header); status != DecodeStatus::decoded) {
    return {.status = status};
  }
  const DecodeStatus place = cutter_.begin_packet({.frame_id = header.frame_id,
                                                   .init_id = header.init_id,
                                                   .number = header.first_column / shape_.columns,
                                                   .first_firing_ns = header.first_firing_ns,
                                                   .receive_utc_ns = packet.receive_utc_ns},
                                                  sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  const std::byte* pixels = packet.payload.data() + shape_.first_column_at + shape_.first_pixel_at;
  for (std::size_t i = 0; i < shape_.columns; ++i, pixels += shape_.column_bytes) {
    if (!header.valid[i]) continue;
    projector_.project(pixels, header.first_column + i, cutter_.time_of(header.firing_ns[i]),
                       sweeps.current());
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = cutter_.end_packet(sweeps)};
}

}  // namespace landfix::drivers::ouster
