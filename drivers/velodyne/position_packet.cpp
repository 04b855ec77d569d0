#include "drivers/velodyne/position_packet.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "drivers/civil_time.hpp"
#include "drivers/little_endian.hpp"
#include "drivers/sensor_clock.hpp"
#include "drivers/velodyne/wire.hpp"

namespace landfix::drivers::velodyne {
namespace {

constexpr std::size_t kTimeAt = 198;
constexpr std::size_t kPulseAt = 202;
constexpr std::size_t kSentenceAt = 206;
constexpr std::size_t kSentenceBytes = 128;
constexpr double kKnotMps = 1852.0 / 3600.0;

/// A substring that may reach beyond the end: substr() of the standard throws, if not optimised away.
[[nodiscard]] std::string_view part(std::string_view text, std::size_t at, std::size_t count) noexcept {
  const std::size_t first = std::min(at, text.size());
  return {text.data() + first, std::min(count, text.size() - first)};
}

/// Digits, and where there are any, decimals: "4807.038". Nothing for anything else.
[[nodiscard]] std::optional<double> to_decimal(std::string_view text) noexcept {
  constexpr std::size_t kLongest = 15;  // a double holds them all
  if (text.empty() || text == "." || text.size() > kLongest) return std::nullopt;
  double value = 0.0;
  double place = 0.0;
  for (const char c : text) {
    if (c == '.' && place == 0.0) {
      place = 1.0;
      if (text.size() == 1) return std::nullopt;
    } else if (c >= '0' && c <= '9') {
      value = 10.0 * value + (c - '0');
      place *= 10.0;
    } else {
      return std::nullopt;
    }
  }
  return place == 0.0 ? value : value / place;
}

/// Exactly two digits.
[[nodiscard]] std::optional<int> two_digits(std::string_view text, std::size_t at) noexcept {
  if (text.size() < at + 2) return std::nullopt;
  const auto value = to_decimal(part(text, at, 2));
  if (!value || text[at] == '.' || text[at + 1] == '.') return std::nullopt;
  return static_cast<int>(*value);
}

[[nodiscard]] int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// A byte that is not documented vouches for nothing.
[[nodiscard]] PulseState pulse_of(std::byte state) noexcept {
  return state <= static_cast<std::byte>(PulseState::error) ? static_cast<PulseState>(state)
                                                            : PulseState::error;
}

/// What is between $ and *, if the checksum behind it fits: the exclusive or of all its characters.
[[nodiscard]] std::optional<std::string_view> checked(std::string_view sentence) noexcept {
  const auto star = sentence.find('*');
  if (!sentence.starts_with('$') || star == std::string_view::npos || sentence.size() < star + 3) {
    return std::nullopt;
  }
  const std::string_view body = part(sentence, 1, star - 1);
  int sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  const int high = hex_digit(sentence[star + 1]);
  const int low = hex_digit(sentence[star + 2]);
  if (high < 0 || low < 0 || 16 * high + low != sum) return std::nullopt;
  return body;
}

/// The fields of a recommended minimum sentence, from the time on.
struct Fields {
  std::string_view time, status, latitude, north_south, longitude, east_west, speed, course, date;
};

[[nodiscard]] std::optional<Fields> fields_of(std::string_view body) noexcept {
  if (body.size() < 6 || part(body, 2, 4) != "RMC,") return std::nullopt;
  body.remove_prefix(6);
  Fields fields;
  for (std::string_view* const field :
       {&fields.time, &fields.status, &fields.latitude, &fields.north_south, &fields.longitude,
        &fields.east_west, &fields.speed, &fields.course, &fields.date}) {
    const auto end = std::min(body.find(','), body.size());
    *field = part(body, 0, end);
    body.remove_prefix(std::min(end + 1, body.size()));
  }
  return fields;
}

/// "hhmmss" or "hhmmss.ss" and "ddmmyy" to Unix nanoseconds.
[[nodiscard]] std::optional<std::int64_t> time_of(const Fields& fields) noexcept {
  const auto hour = two_digits(fields.time, 0);
  const auto minute = two_digits(fields.time, 2);
  const auto second = two_digits(fields.time, 4);
  const auto day = two_digits(fields.date, 0);
  const auto month = two_digits(fields.date, 2);
  const auto year = two_digits(fields.date, 4);
  if (!hour || !minute || !second || !day || !month || !year) return std::nullopt;
  const auto seconds = unix_seconds({.year = 2000 + *year,
                                     .month = *month,
                                     .day = *day,
                                     .hour = *hour,
                                     .minute = *minute,
                                     .second = *second});
  if (!seconds) return std::nullopt;
  return *seconds * 1'000'000'000;
}

/// "ddmm.mmmm" or "dddmm.mmmm" with its hemisphere; nothing beyond `most_deg`.
[[nodiscard]] std::optional<double> angle_of(std::string_view text, std::string_view hemisphere,
                                             char positive, char negative, double most_deg) noexcept {
  const auto value = to_decimal(text);
  if (!value || hemisphere.size() != 1) return std::nullopt;
  if (hemisphere[0] != positive && hemisphere[0] != negative) return std::nullopt;
  if (*value > 100.0 * most_deg) return std::nullopt;  // an int might not hold it
  const auto degrees = static_cast<double>(static_cast<int>(*value / 100.0));
  const double minutes = *value - 100.0 * degrees;
  const double angle_deg = degrees + minutes / 60.0;
  if (minutes >= 60.0 || angle_deg > most_deg) return std::nullopt;
  return hemisphere[0] == positive ? angle_deg : -angle_deg;
}

[[nodiscard]] std::optional<PositionFix> fix_of(const Fields& fields) noexcept {
  const auto latitude_deg = angle_of(fields.latitude, fields.north_south, 'N', 'S', 90.0);
  const auto longitude_deg = angle_of(fields.longitude, fields.east_west, 'E', 'W', 180.0);
  if (!latitude_deg || !longitude_deg) return std::nullopt;
  // A receiver that stands still leaves speed and course empty.
  return PositionFix{.latitude_deg = *latitude_deg,
                     .longitude_deg = *longitude_deg,
                     .speed_mps = to_decimal(fields.speed).value_or(0.0) * kKnotMps,
                     .course_deg = to_decimal(fields.course).value_or(0.0)};
}

}  // namespace

std::optional<PositionPacket> parse_position_packet(std::span<const std::byte> payload) noexcept {
  if (payload.size() != kPositionBytes) return std::nullopt;
  PositionPacket packet{.top_of_hour_us = load_little_endian<std::uint32_t>(&payload[kTimeAt]),
                        .pulse = pulse_of(payload[kPulseAt]),
                        .utc_ns = {},
                        .fix = {}};
  if (packet.top_of_hour_us > kLatestTopOfHourUs) return std::nullopt;
  std::array<char, kSentenceBytes> text;
  std::ranges::transform(payload.subspan(kSentenceAt, kSentenceBytes), text.begin(),
                         [](std::byte byte) { return static_cast<char>(byte); });
  const auto body = checked({text.data(), text.size()});
  const auto fields = body ? fields_of(*body) : std::nullopt;
  if (!fields || fields->status != "A") return packet;
  packet.fix = fix_of(*fields);
  const auto receiver_ns = time_of(*fields);
  if (receiver_ns && packet.pulse == PulseState::locked) {
    // The receiver's time is up to a second old.
    packet.utc_ns = nearest_after_hour(std::int64_t{packet.top_of_hour_us} * 1000, *receiver_ns);
  }
  return packet;
}

DecodeStatus read_position(const Packet& packet, SweepBuilder& builder,
                           std::optional<PositionFix>& fix) noexcept {
  const auto position = parse_position_packet(packet.payload);
  if (!position) return DecodeStatus::wrong_time;
  fix = position->fix;
  if (position->utc_ns) builder.learn_utc(*position->utc_ns, packet.receive_utc_ns);
  return DecodeStatus::telemetry;
}

}  // namespace landfix::drivers::velodyne
