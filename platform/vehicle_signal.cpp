#include "platform/vehicle_signal.hpp"

#include <algorithm>

namespace landfix::platform {
namespace {

/// The place of a bit when those of each byte are counted from the most significant: Motorola's signals run
/// on in it.
[[nodiscard]] unsigned mirrored(unsigned bit) noexcept { return bit ^ 7U; }

[[nodiscard]] bool bit_of(std::span<const std::byte> payload, unsigned bit) noexcept {
  return bit / 8 < payload.size() && (std::to_integer<unsigned>(payload[bit / 8]) >> bit % 8 & 1U) != 0;
}

[[nodiscard]] double number_of(std::uint64_t raw, RawField field) noexcept {
  if (!field.is_signed) return static_cast<double>(raw);
  const unsigned unused = 64U - field.length;
  return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
}

}  // namespace

std::size_t bytes_of(RawField field) noexcept {
  const unsigned first = field.motorola ? mirrored(field.start) : field.start;
  return (first + field.length + 7U) / 8U;
}

std::uint64_t read_raw(std::span<const std::byte> payload, RawField field) noexcept {
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < field.length; ++i) {
    const unsigned bit =
        field.motorola ? mirrored(mirrored(field.start) + i) : field.start + field.length - 1U - i;
    raw = raw << 1U | (bit_of(payload, bit) ? 1U : 0U);
  }
  return raw;
}

std::optional<double> value_of(const VehicleSignal& signal, const CanFrame& frame) noexcept {
  const auto payload = frame.payload();
  const auto has = [payload](std::uint16_t bit) { return bit / 8U < payload.size(); };
  if (bytes_of(signal.field) > payload.size()) return std::nullopt;
  if (signal.sign_bit && !has(*signal.sign_bit)) return std::nullopt;
  if (signal.valid_bit &&
      (!has(*signal.valid_bit) || bit_of(payload, *signal.valid_bit) != signal.valid_value))
    return std::nullopt;
  const std::uint64_t raw = read_raw(payload, signal.field);
  const auto invalid = std::span(signal.invalid_raw).first(signal.invalid_count);
  if (std::find(invalid.begin(), invalid.end(), raw) != invalid.end()) return std::nullopt;
  double value = number_of(raw, signal.field) * signal.scale + signal.offset;
  if (signal.sign_bit && bit_of(payload, *signal.sign_bit)) value = -value;
  if (!(value >= signal.low && value <= signal.high)) return std::nullopt;
  return value;
}

bool VehicleSignals::has(VehicleRole role) const noexcept {
  const auto signals_of = all();
  return std::any_of(signals_of.begin(), signals_of.end(),
                     [role](const VehicleSignal& signal) { return signal.role == role; });
}

std::optional<double> LatestValue::at(std::int64_t stamp_utc_ns) const noexcept {
  constexpr std::int64_t kClockWasSet_ns = 500'000'000;  // back, since it was told
  if (timeout_ns_ < 0) return std::nullopt;
  const std::int64_t age_ns = stamp_utc_ns - stamp_utc_ns_;
  if (age_ns > timeout_ns_ || age_ns < -kClockWasSet_ns) return std::nullopt;
  return value_;
}

}  // namespace landfix::platform
