#include "tools/simulator/ouster_packets.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator::ouster {
namespace {

/// Bits [high:low] of a pixel, counted from the lowest bit of its first byte.
struct Bits {
  unsigned high = 0;
  unsigned low = 0;
};

struct Return {
  Bits range;
  Bits reflectivity;
  Bits flags;
};

struct Pixel {
  std::string_view name;
  std::size_t bytes = 0;
  unsigned range_unit_mm = 1;
  Return first;
  std::optional<Return> second;
  std::optional<Bits> near_infrared;
};

constexpr Return kFirst19{.range = {18, 0}, .reflectivity = {31, 24}, .flags = {23, 19}};
constexpr Return kSecond19{.range = {50, 32}, .reflectivity = {63, 56}, .flags = {55, 51}};
constexpr Return kFirst15{.range = {14, 0}, .reflectivity = {23, 16}, .flags = {15, 15}};
constexpr Return kSecond15{.range = {46, 32}, .reflectivity = {55, 48}, .flags = {47, 47}};
constexpr Return kSingle19{.range = {18, 0}, .reflectivity = {39, 32}, .flags = {23, 19}};

/// In the order of Profile.
constexpr std::array<Pixel, kProfileCount> kPixels{{
    {"LEGACY", 12, 1, {.range = {19, 0}, .reflectivity = {39, 32}, .flags = {31, 28}}, {}, Bits{79, 64}},
    {"RNG19_RFL8_SIG16_NIR16", 12, 1, kSingle19, {}, Bits{79, 64}},
    {"RNG19_RFL8_SIG16_NIR16_DUAL", 16, 1, kFirst19, kSecond19, Bits{111, 96}},
    {"RNG15_RFL8_NIR8", 4, 8, kFirst15, {}, Bits{31, 24}},
    {"FUSA_RNG15_RFL8_NIR8_DUAL", 8, 8, kFirst15, kSecond15, Bits{31, 24}},
    {"RNG15_RFL8_NIR8_DUAL", 8, 8, kFirst15, kSecond15, Bits{31, 24}},
    {"RNG19_RFL8_SIG16_NIR16_ZONE16", 12, 1, kSingle19, {}, Bits{79, 64}},
    {"RNG19_RFL8_SIG16_ZONE16_DUAL", 16, 1, kFirst19, kSecond19, {}},
    {"RNG15_RFL8_NIR8_ZONE16", 8, 8, kFirst15, {}, Bits{31, 24}},
    {"RNG15_RFL8_WIN8", 4, 8, kFirst15, {}, {}},
    {"FIVE_WORD_PIXEL", 20, 1, kFirst19, kSecond19, Bits{111, 96}},
    {"RNG19_RFL8_SIG16_NIR16_RGB16", 16, 1, kFirst19, {}, Bits{63, 48}},
    {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", 20, 1, kFirst19, kSecond19, Bits{111, 96}},
}};

const Pixel& pixel_of(Profile profile) { return kPixels[static_cast<std::size_t>(profile)]; }

void put_bits(std::span<std::byte> pixel, Bits bits, std::uint64_t value) noexcept {
  for (unsigned bit = bits.low; bit <= bits.high; ++bit, value >>= 1) {
    if ((value & 1U) != 0) pixel[bit / 8] |= std::byte{1} << (bit % 8);
  }
}

void put_echo(std::span<std::byte> bytes, const Pixel& pixel, const Return& place,
              const Echo& echo) noexcept {
  const double raw = std::round(1e3 * echo.range_m / pixel.range_unit_mm);
  const auto most = static_cast<double>((1U << (place.range.high - place.range.low + 1)) - 1);
  put_bits(bytes, place.range, raw >= 1.0 && raw <= most ? static_cast<std::uint64_t>(raw) : 0);
  put_bits(bytes, place.reflectivity, echo.reflectivity);
  // What the flags mean is the sensor's affair; bright ones are often set.
  put_bits(bytes, place.flags, echo.reflectivity > 60 ? 1 : 0);
}

/// CRC-64/XZ, byte by byte.
std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
  static constexpr auto kTable = [] {
    std::array<std::uint64_t, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      std::uint64_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1U) != 0 ? 0xC96C5795D7870F42 : 0);
      table[i] = value;
    }
    return table;
  }();
  std::uint64_t crc = ~std::uint64_t{0};
  for (const std::byte byte : bytes) {
    crc = (crc >> 8) ^ kTable[(crc ^ std::to_integer<std::uint64_t>(byte)) & 0xFF];
  }
  return ~crc;
}

void put_checksum(const PacketFormat& format, std::span<std::byte> bytes) noexcept {
  if (format.checksum) put_little(bytes, bytes.size() - 8, checksum(bytes.first(bytes.size() - 8)), 8);
}

void put_header(const PacketFormat& format, std::uint32_t frame_id, unsigned type,
                std::span<std::byte> bytes) noexcept {
  put_little(bytes, 0, type, format.fusa_header ? 1 : 2);
  put_little(bytes, format.fusa_header ? 4 : 2, frame_id, format.fusa_header ? 4 : 2);
  put_little(bytes, format.fusa_header ? 1 : 4, format.init_id, 3);
  put_little(bytes, format.fusa_header ? 11 : 7, format.serial_number, 5);
}

void put_float(std::span<std::byte> bytes, std::size_t at, float value) noexcept {
  put_little(bytes, at, std::bit_cast<std::uint32_t>(value), 4);
}

}  // namespace

std::string_view name_of(Profile profile) noexcept { return pixel_of(profile).name; }

bool has_second_return(Profile profile) noexcept { return pixel_of(profile).second.has_value(); }

std::vector<std::byte> lidar_packet(const PacketFormat& format, const PacketMoment& moment,
                                    std::span<const Echo> echoes, std::span<const Echo> second) {
  const Pixel& pixel = pixel_of(format.profile);
  const bool legacy = format.profile == Profile::legacy;
  const std::size_t before = legacy ? 16 : 12;
  const std::size_t column_bytes = before + format.rows * pixel.bytes + (legacy ? 4 : 0);
  std::vector<std::byte> bytes(kColumnsPerPacket * column_bytes + (legacy ? 0 : 64));
  if (!legacy) put_header(format, moment.frame_id, 1, bytes);
  for (std::size_t k = 0; k < kColumnsPerPacket; ++k) {
    const auto column = std::span(bytes).subspan((legacy ? 0 : 32) + k * column_bytes, column_bytes);
    const std::size_t id = moment.first_column + k;
    put_little(column, 0,
               static_cast<std::uint64_t>(moment.utc_ns + static_cast<std::int64_t>(k) * moment.column_ns),
               8);
    put_little(column, 8, id, 2);
    if (legacy) {
      put_little(column, 10, moment.frame_id, 2);
      put_little(column, 12, id * (90112 / format.columns_per_turn), 4);
      put_little(column, column_bytes - 4, 0xFFFFFFFF, 4);
    } else {
      put_little(column, 10, 1, 2);
    }
    for (std::size_t row = 0; row < format.rows; ++row) {
      const auto at = column.subspan(before + row * pixel.bytes, pixel.bytes);
      put_echo(at, pixel, pixel.first, echoes[k * format.rows + row]);
      if (pixel.second && !second.empty()) put_echo(at, pixel, *pixel.second, second[k * format.rows + row]);
      // There is light whether or not there is an echo.
      if (pixel.near_infrared) put_bits(at, *pixel.near_infrared, 90);
    }
  }
  if (!legacy) put_checksum(format, bytes);
  return bytes;
}

std::vector<std::byte> imu_packet(std::int64_t utc_ns) {
  constexpr std::int64_t kBetweenReads_ns = 222'000;
  std::vector<std::byte> bytes(48);
  put_little(bytes, 0, static_cast<std::uint64_t>(utc_ns % 1'000'000'000'000),
             8);  // since it was switched on
  put_little(bytes, 8, static_cast<std::uint64_t>(utc_ns), 8);
  put_little(bytes, 16, static_cast<std::uint64_t>(utc_ns + kBetweenReads_ns), 8);
  put_float(bytes, 32, 1.0F);  // g, upwards
  return bytes;
}

std::vector<std::byte> nmea_imu_packet(const PacketFormat& format, std::int64_t utc_ns) {
  constexpr std::size_t kMeasurements = 4;
  constexpr std::int64_t kPeriod_ns = 1'562'500;
  std::vector<std::byte> bytes(164 + 36 * kMeasurements);
  put_header(format, static_cast<std::uint32_t>(utc_ns / 100'000'000) & 0xFFFF, 2, bytes);
  put_little(bytes, 32, static_cast<std::uint64_t>(utc_ns), 8);
  for (std::size_t i = 0; i < kMeasurements; ++i) {
    const std::size_t at = 132 + 36 * i;
    put_little(bytes, at, static_cast<std::uint64_t>(utc_ns + static_cast<std::int64_t>(i) * kPeriod_ns), 8);
    put_little(bytes, at + 8, 32 * i + 31, 2);
    put_little(bytes, at + 10, 1, 2);
    put_float(bytes, at + 20, 9.80665F);
  }
  put_checksum(format, bytes);
  return bytes;
}

}  // namespace landfix::tools::simulator::ouster
