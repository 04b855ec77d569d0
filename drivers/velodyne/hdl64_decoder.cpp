#include "drivers/velodyne/hdl64_decoder.hpp"

#include <cstddef>
#include <cstdlib>

#include "drivers/sensor_clock.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kHourNs = 3600 * kSecondNs;
/// The blocks of a pair fire together; more than this between their azimuths is damage.
constexpr int kPairWithinCentideg = 100;

/// How a packet of each layout is made up.
struct Cadence {
  std::size_t blocks;  ///< a firing
  std::int64_t firing_ns;
};
constexpr Cadence cadence(Hdl64Layout layout) noexcept {
  switch (layout) {
    case Hdl64Layout::single:
      return {2, 48'000};
    case Hdl64Layout::dual:
      return {4, 57'600};
    case Hdl64Layout::s1:
      break;
  }
  return {1, 32'000};
}
constexpr std::int64_t packet_ns(Hdl64Layout layout) noexcept {
  return static_cast<std::int64_t>(kBlocks / cadence(layout).blocks) * cadence(layout).firing_ns;
}
static_assert(packet_ns(Hdl64Layout::single) == 288'000);
static_assert(packet_ns(Hdl64Layout::dual) == 172'800);
static_assert(packet_ns(Hdl64Layout::s1) == Hdl64S1Clock::kPacketNs);

/// A packet is sent when it is full.
std::int64_t start_of_sending(std::int64_t receive_utc_ns, std::int64_t duration_ns) noexcept {
  return receive_utc_ns > duration_ns ? receive_utc_ns - duration_ns : 0;
}

Hdl64Layout read_as(Hdl64Layout layout, Hdl64Generation generation) noexcept {
  // Only the S3 sends two returns: another one's rotor stands still.
  const bool cannot_be_dual = layout == Hdl64Layout::dual && generation != Hdl64Generation::s3;
  return cannot_be_dual ? Hdl64Layout::single : layout;
}

}  // namespace

Hdl64Decoder::Hdl64Decoder(Hdl64Generation generation, const Hdl64Calibration* calibration,
                           const DecoderOptions& options) noexcept
    : projector_(options),
      builder_(options.cut_deg),
      collector_(generation == Hdl64Generation::s3 ? Hdl64Checksum::crc16 : Hdl64Checksum::constant),
      generation_(generation),
      from_file_(calibration != nullptr),
      calibrated_(from_file_),
      time_is_packet_end_(options.hdl64_time_is_packet_end) {
  if (!from_file_) return;
  calibration_ = *calibration;
  projector_.set_calibration(calibration_);
}

DecodeStatus Hdl64Decoder::validate(std::span<const std::byte> payload, Header& header) const noexcept {
  if (payload.size() != sizeof(WirePacket)) return DecodeStatus::wrong_size;
  const auto layout = hdl64_layout(payload);
  if (!layout) return DecodeStatus::wrong_header;
  if (*layout == Hdl64Layout::s1 && generation_ != Hdl64Generation::s1) return DecodeStatus::wrong_model;
  header.layout = read_as(*layout, generation_);

  const std::size_t blocks = cadence(header.layout).blocks;
  header.firings = kBlocks / blocks;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::uint16_t azimuth_centideg = hdl64_azimuth(payload, b);
    if (azimuth_centideg >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
    std::uint16_t& of_firing = header.firing_azimuth_centideg[b / blocks];
    if (b % blocks == 0) of_firing = azimuth_centideg;
    const int apart_centideg = std::abs(azimuth_centideg - of_firing);
    if (apart_centideg > kPairWithinCentideg && apart_centideg < kTurnCentideg - kPairWithinCentideg) {
      return DecodeStatus::wrong_azimuth;
    }
  }
  if (builder_.cannot_be(std::span(header.firing_azimuth_centideg).first(header.firings))) {
    return DecodeStatus::wrong_azimuth;
  }
  if (header.layout == Hdl64Layout::s1) return DecodeStatus::decoded;
  header.top_of_hour_us = load_little_endian<std::uint32_t>(payload.data() + kBlocks * sizeof(WireBlock));
  return header.top_of_hour_us <= kLatestTopOfHourUs ? DecodeStatus::decoded : DecodeStatus::wrong_time;
}

void Hdl64Decoder::measure_rotation(const Header& header) noexcept {
  // The S1's encoder has steps of 0.09 deg: from one lower block to the next they show less.
  const std::size_t stride = header.layout == Hdl64Layout::s1 ? 4 : 1;
  std::array<std::uint16_t, kBlocks> azimuths_centideg;
  std::size_t count = 0;
  for (std::size_t firing = 0; firing < header.firings; firing += stride) {
    azimuths_centideg[count++] = header.firing_azimuth_centideg[firing];
  }
  const double step_us =
      1e-3 * static_cast<double>(cadence(header.layout).firing_ns) * static_cast<double>(stride);
  // What the first packet shows is all there is, the estimate moves on to it by as many small steps.
  const int steps = rotation_is_known_ ? 1 : 64;
  for (int i = 0; i < steps; ++i) spin_rate_.update(std::span(azimuths_centideg).first(count), step_us);
  rotation_is_known_ = true;
  projector_.set_rotation(header.layout, spin_rate_.rad_per_s());
}

void Hdl64Decoder::read_status(std::span<const std::byte> payload, std::int64_t sensor_ns,
                               std::int64_t receive_utc_ns) noexcept {
  const auto type = std::to_integer<std::uint8_t>(payload[sizeof(WirePacket) - 2]);
  const auto value = std::to_integer<std::uint8_t>(payload[sizeof(WirePacket) - 1]);
  if (const auto utc_s = calendar_.take(type, value)) {
    const std::int64_t said_ns = *utc_s * kSecondNs;
    // By the receiver's clock it may be before 1970.
    const std::int64_t after_hour_ns = (sensor_ns % kHourNs + kHourNs) % kHourNs;
    const std::int64_t utc_ns = nearest_after_hour(after_hour_ns, said_ns);
    // Minutes and seconds are said twice: by the status and by the packet's time.
    if (std::abs(utc_ns - said_ns) < 2 * kSecondNs) builder_.learn_utc(utc_ns, receive_utc_ns);
  }
  Hdl64Calibration sent;
  if (!collector_.take(type, value, sent)) return;
  // The unit's file has more digits; whether intensities are corrected is the unit's present setting.
  if (from_file_) sent.lasers = calibration_.lasers;
  if (calibrated_ && sent == calibration_) return;
  calibration_ = sent;
  calibrated_ = true;
  projector_.set_calibration(calibration_);
}

void Hdl64Decoder::project_firing(std::span<const std::byte> payload, const Header& header,
                                  std::size_t firing, float time_s, Sweep& sweep) const noexcept {
  const std::size_t blocks = cadence(header.layout).blocks;
  for (std::size_t b = firing * blocks; b < (firing + 1) * blocks; ++b) {
    const auto slots_of = [&](std::size_t block) {
      return payload.data() + block * sizeof(WireBlock) + offsetof(WireBlock, slots);
    };
    // Two returns: the pair of the strongest, then the pair of the last.
    const bool is_second = b - firing * blocks >= 2;
    projector_.project({.slots = slots_of(b),
                        .duplicates = is_second ? slots_of(b - 2) : nullptr,
                        .first_laser = flag_of_block(payload, b) == kUpperBlock ? std::size_t{0} : 32,
                        .azimuth_centideg = hdl64_azimuth(payload, b),
                        .time_s = time_s},
                       sweep);
  }
}

DecodeResult Hdl64Decoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  Header header;
  if (const auto status = validate(packet.payload, header); status != DecodeStatus::decoded)
    return {.status = status};
  measure_rotation(header);

  const std::int64_t duration_ns = packet_ns(header.layout);
  std::int64_t first_firing_ns = 0;
  std::int64_t receive_utc_ns = packet.receive_utc_ns;
  if (header.layout == Hdl64Layout::s1) {
    first_firing_ns = s1_clock_.take(header.firing_azimuth_centideg[0], spin_rate_.turn_ns(), receive_utc_ns);
    receive_utc_ns = start_of_sending(receive_utc_ns, duration_ns);
  } else {
    const auto sensor_ns = [&] {
      return builder_.clock().expand_top_of_hour(header.top_of_hour_us, receive_utc_ns);
    };
    if (generation_ != Hdl64Generation::s1) read_status(packet.payload, sensor_ns(), receive_utc_ns);
    if (!calibrated_) return {.status = DecodeStatus::uncalibrated};
    first_firing_ns = sensor_ns() - (time_is_packet_end_ ? duration_ns : 0);  // by the hour that it has said
  }
  const DecodeStatus place = builder_.begin_packet({.first_firing_ns = first_firing_ns,
                                                    .receive_utc_ns = receive_utc_ns,
                                                    .duration_ns = duration_ns,
                                                    .turn_ns = spin_rate_.turn_ns(),
                                                    .sequence = {}},
                                                   header.firing_azimuth_centideg[0], sweeps);
  if (place != DecodeStatus::decoded) return {.status = place};
  for (std::size_t firing = 0; firing < header.firings; ++firing) {
    const auto firing_ns =
        first_firing_ns + static_cast<std::int64_t>(firing) * cadence(header.layout).firing_ns;
    const float time_s = builder_.begin_block(header.firing_azimuth_centideg[firing], firing_ns, sweeps);
    project_firing(packet.payload, header, firing, time_s, sweeps.current());
  }
  return {.status = DecodeStatus::decoded, .sweep_completed = builder_.has_cut()};
}

}  // namespace landfix::drivers::velodyne
