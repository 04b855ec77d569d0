#include "tools/simulator/pandar_packets.hpp"

#include <chrono>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "tools/simulator/nmea_sentence.hpp"
#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator::pandar {
namespace {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kTailBytes = 22;
constexpr std::uint64_t kBlockMarker = 0xFFEE;
constexpr std::uint64_t kHeaderMarker = 0xEEFF;
constexpr std::uint64_t kRangeUnit_mm = 4;
constexpr std::uint64_t kRpm = 600;
constexpr std::uint64_t kStrongestReturn = 0x37;
constexpr std::uint64_t kFactory = 0x42;

std::size_t block_bytes(const Form& form) noexcept { return (form.header ? 2 : 4) + 3 * form.channels; }
std::size_t header_bytes(const Form& form) noexcept { return form.header ? kHeaderBytes : 0; }

struct Calendar {
  std::chrono::year_month_day date;
  std::chrono::hh_mm_ss<std::chrono::seconds> time;
};

Calendar calendar(std::int64_t utc_ns) noexcept {
  const std::chrono::sys_seconds second{std::chrono::seconds(utc_ns / 1'000'000'000)};
  const auto day = std::chrono::floor<std::chrono::days>(second);
  return {.date = day, .time = std::chrono::hh_mm_ss(second - day)};
}

std::uint64_t microseconds(std::int64_t utc_ns) noexcept {
  return static_cast<std::uint64_t>(utc_ns % 1'000'000'000 / 1000);
}

}  // namespace

DataPacket::DataPacket(const Form& form)
    : form_(form),
      tail_at_(header_bytes(form) + form.blocks * block_bytes(form)),
      bytes_(tail_at_ + kTailBytes + (form.numbered ? 4 : 0)) {
  if (form.header) {
    put_big(bytes_, 0, kHeaderMarker, 2);
    put_little(bytes_, 2, form.channels, 1);
    put_little(bytes_, 3, form.blocks, 1);
    put_little(bytes_, 5, kRangeUnit_mm, 1);
  } else {
    for (std::size_t block = 0; block < form.blocks; ++block) {
      put_big(bytes_, block * block_bytes(form), kBlockMarker, 2);
    }
  }
  put_little(bytes_, tail_at_ + 8, kRpm, 2);
  put_little(bytes_, tail_at_ + 14, kStrongestReturn, 1);
  put_little(bytes_, tail_at_ + 15, kFactory, 1);
}

std::size_t DataPacket::azimuth_at(std::size_t block) const noexcept {
  return header_bytes(form_) + block * block_bytes(form_) + (form_.header ? 0 : 2);
}

void DataPacket::put_azimuth(std::size_t block, std::uint16_t azimuth_centideg) noexcept {
  put_little(bytes_, azimuth_at(block), azimuth_centideg, 2);
}

void DataPacket::put_return(std::size_t block, std::size_t channel, std::uint16_t range_raw,
                            std::uint8_t reflectivity) noexcept {
  const std::size_t at = azimuth_at(block) + 2 + 3 * channel;
  put_little(bytes_, at, range_raw, 2);
  put_little(bytes_, at + 2, reflectivity, 1);
}

void DataPacket::put_time(std::int64_t utc_ns) noexcept {
  const Calendar utc = calendar(utc_ns);
  put_little(bytes_, tail_at_ + 10, microseconds(utc_ns), 4);
  const std::uint64_t fields[] = {static_cast<std::uint64_t>(int{utc.date.year()} - form_.year_zero),
                                  unsigned{utc.date.month()},
                                  unsigned{utc.date.day()},
                                  static_cast<std::uint64_t>(utc.time.hours().count()),
                                  static_cast<std::uint64_t>(utc.time.minutes().count()),
                                  static_cast<std::uint64_t>(utc.time.seconds().count())};
  for (std::size_t i = 0; i < std::size(fields); ++i) put_little(bytes_, tail_at_ + 16 + i, fields[i], 1);
}

void DataPacket::put_sequence(std::uint32_t sequence) noexcept {
  put_little(bytes_, tail_at_ + kTailBytes, sequence, 4);
}

std::vector<std::byte> gps_packet(const GpsFix& fix) {
  std::vector<std::byte> payload(512, std::byte{0xDF});
  const auto put_text = [&payload](std::size_t at, std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) payload[at + i] = static_cast<std::byte>(text[i]);
  };
  put_big(payload, 0, kBlockMarker, 2);
  const std::chrono::sys_seconds second{std::chrono::seconds(fix.utc_ns / 1'000'000'000)};
  // Each number of two digits with its units first.
  std::string stamp = fmt::format("{:%y%m%d%S%M%H}", second);
  for (std::size_t i = 0; i < stamp.size(); i += 2) std::swap(stamp[i], stamp[i + 1]);
  put_text(2, stamp);
  put_little(payload, 14, microseconds(fix.utc_ns), 4);
  put_text(18, nmea_sentence(fix));
  put_text(506, "A");
  put_little(payload, 507, 1, 1);
  put_little(payload, 508, 0, 4);
  return payload;
}

}  // namespace landfix::tools::simulator::pandar
