#include "platform/can_signal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace landfix::platform {
namespace {

RawValue encode_number(const Signal& signal, double value) noexcept {
  if (std::isnan(value)) return {.raw = signal.not_available()};
  const double steps = std::nearbyint(value / signal.scale);  // the default rounding mode: half to even
  const auto low = static_cast<double>(signal.lowest());
  const auto high = static_cast<double>(signal.highest());
  const auto raw = static_cast<std::int64_t>(std::clamp(steps, low, high));
  return {.raw = static_cast<std::uint64_t>(raw) & signal.bits.mask(),
          .saturated = steps < low || steps > high};
}

double decode_number(const Signal& signal, std::uint64_t raw) noexcept {
  if (raw == signal.not_available()) return PoseReport::kNone;
  const bool is_negative = signal.bits.is_signed && raw > signal.highest();
  const auto steps = static_cast<std::int64_t>(is_negative ? raw | ~signal.bits.mask() : raw);
  return static_cast<double>(steps) * signal.scale;
}

std::uint64_t step_ns(const Signal& signal) noexcept {
  return static_cast<std::uint64_t>(std::nearbyint(signal.scale * 1e9));
}

RawValue encode_time(const Signal& signal, std::int64_t stamp_utc_ns) noexcept {
  if (stamp_utc_ns < 0) return {.raw = signal.not_available()};
  const std::uint64_t step = step_ns(signal);
  const std::uint64_t whole = static_cast<std::uint64_t>(stamp_utc_ns) / step;
  const std::uint64_t twice_rest = 2 * (static_cast<std::uint64_t>(stamp_utc_ns) % step);
  const bool rounds_up = twice_rest > step || (twice_rest == step && whole % 2 == 1);
  const std::uint64_t steps = whole + (rounds_up ? 1 : 0);
  return {.raw = std::min(steps, signal.highest()), .saturated = steps > signal.highest()};
}

std::int64_t decode_time(const Signal& signal, std::uint64_t raw) noexcept {
  constexpr std::uint64_t kLatest_ns = std::numeric_limits<std::int64_t>::max();
  const std::uint64_t step = step_ns(signal);
  if (raw == signal.not_available() || raw > kLatest_ns / step) return PoseReport::kNoTime;
  return static_cast<std::int64_t>(raw * step);
}

}  // namespace

std::uint64_t get_bits(std::span<const std::byte> frame, Bits bits) noexcept {
  std::uint64_t raw = 0;
  for (unsigned done = 0; done < bits.length;) {
    const unsigned at = bits.start + done;
    const std::uint64_t byte = at / 8 < frame.size() ? std::to_integer<std::uint64_t>(frame[at / 8]) : 0;
    raw |= byte >> at % 8 << done;
    done += 8 - at % 8;
  }
  return raw & bits.mask();
}

void put_bits(std::span<std::byte> frame, Bits bits, std::uint64_t raw) noexcept {
  raw &= bits.mask();
  for (unsigned done = 0; done < bits.length;) {
    const unsigned at = bits.start + done;
    const auto kept = static_cast<std::byte>(~(bits.mask() >> done << at % 8) & 0xFF);
    if (at / 8 < frame.size()) {
      frame[at / 8] = (frame[at / 8] & kept) | static_cast<std::byte>(raw >> done << at % 8 & 0xFF);
    }
    done += 8 - at % 8;
  }
}

RawValue encode_signal(const Signal& signal, const PoseReport& report) noexcept {
  if (const auto* number = std::get_if<double PoseReport::*>(&signal.field)) {
    return encode_number(signal, report.**number);
  }
  if (const auto* time = std::get_if<std::int64_t PoseReport::*>(&signal.field)) {
    return encode_time(signal, report.**time);
  }
  const auto* code = std::get_if<std::uint16_t PoseReport::*>(&signal.field);
  const std::uint64_t value = report.**code;
  return {.raw = std::min(value, signal.highest()), .saturated = value > signal.highest()};
}

void decode_signal(const Signal& signal, std::uint64_t raw, PoseReport& report) noexcept {
  if (const auto* number = std::get_if<double PoseReport::*>(&signal.field)) {
    report.** number = decode_number(signal, raw);
  } else if (const auto* time = std::get_if<std::int64_t PoseReport::*>(&signal.field)) {
    report.** time = decode_time(signal, raw);
  } else if (const auto* code = std::get_if<std::uint16_t PoseReport::*>(&signal.field)) {
    report.** code = static_cast<std::uint16_t>(raw);
  }
}

}  // namespace landfix::platform
