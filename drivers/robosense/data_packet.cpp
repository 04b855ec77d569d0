#include "drivers/robosense/data_packet.hpp"

#include <algorithm>
#include <optional>

#include "drivers/big_endian.hpp"
#include "drivers/civil_time.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/sweep_cutter.hpp"

namespace landfix::drivers::robosense {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

std::optional<std::int64_t> calendar_ns(const std::byte* field) noexcept {
  const auto at = [field](std::size_t i) { return std::to_integer<int>(field[i]); };
  const auto seconds = unix_seconds(
      {.year = 2000 + at(0), .month = at(1), .day = at(2), .hour = at(3), .minute = at(4), .second = at(5)});
  const auto milliseconds = load_big_endian<std::uint16_t>(field + 6);
  const auto microseconds = load_big_endian<std::uint16_t>(field + 8);
  if (!seconds || milliseconds > 999 || microseconds > 999) return std::nullopt;
  return *seconds * kSecondNs + (std::int64_t{milliseconds} * 1000 + microseconds) * 1000;
}

std::optional<std::int64_t> seconds_ns(const std::byte* field) noexcept {
  const auto seconds = load_big_endian<std::int64_t, 6>(field);
  const auto microseconds = load_big_endian<std::uint32_t>(field + 6);
  if (seconds > SensorClock::kLatestNs / kSecondNs || microseconds >= 1'000'000) return std::nullopt;
  return seconds * kSecondNs + std::int64_t{microseconds} * 1000;
}

/// 0 where the byte is none of the two that are known.
double range_unit_m(const Description& model, std::byte choice) noexcept {
  if (model.range_unit_m != 0.0) return model.range_unit_m;
  switch (std::to_integer<unsigned>(choice)) {
    case 0:
      return 0.005;
    case 1:
      return 0.0025;
    default:
      return 0.0;
  }
}

}  // namespace

bool has_magic_of(const Description& model, std::span<const std::byte> payload) noexcept {
  return payload.size() >= model.magic_bytes &&
         std::equal(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(model.magic_bytes),
                    model.magic.begin(),
                    [](std::byte found, std::uint8_t expected) { return found == std::byte{expected}; });
}

DecodeStatus read_data_header(const Description& model, std::span<const std::byte> payload,
                              DataHeader& header) noexcept {
  if (!has_magic_of(model, payload)) {
    const bool of_the_family =
        has_magic_of(kRs32, payload) || has_magic_of(kRs16, payload) || has_magic_of(kHelios16p, payload);
    return of_the_family ? DecodeStatus::wrong_model : DecodeStatus::wrong_header;
  }
  if (load_big_endian<std::uint16_t>(&payload[kTailAt]) != kDataTail) return DecodeStatus::wrong_header;
  header.range_unit_m = range_unit_m(model, payload[kRangeUnitAt]);
  if (header.range_unit_m == 0.0) return DecodeStatus::wrong_header;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::byte* const block = &payload[block_at(b)];
    if (load_big_endian<std::uint16_t>(block) != kBlockFlag) return DecodeStatus::wrong_header;
    header.azimuth_centideg[b] = load_big_endian<std::uint16_t>(block + 2);
    if (header.azimuth_centideg[b] >= kTurnCentideg) return DecodeStatus::wrong_azimuth;
  }
  const std::byte* const time = &payload[kTimeAt];
  const auto first_firing_ns = model.time == TimeForm::calendar ? calendar_ns(time) : seconds_ns(time);
  if (!first_firing_ns) return DecodeStatus::wrong_time;
  header.first_firing_ns = *first_firing_ns;
  return DecodeStatus::decoded;
}

bool come_in_pairs(const std::array<std::uint16_t, kBlocks>& azimuth_centideg) noexcept {
  for (std::size_t b = 0; b < kBlocks; b += 2) {
    if (azimuth_centideg[b] != azimuth_centideg[b + 1]) return false;
  }
  return true;
}

}  // namespace landfix::drivers::robosense
