// The input is a sequence of packets: sound ones of data and device information, with bytes replaced as the
// fuzzer says, so that it need not find a whole packet by chance.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/make_decoder.hpp"
#include "support/robosense_packets.hpp"

namespace {

using landfix::drivers::AnyDecoder;
using landfix::drivers::DecoderOptions;
using landfix::drivers::Point;
using landfix::drivers::SweepPair;

void fuzz(const char* model, const DecoderOptions& options, std::span<const std::byte> input) {
  landfix::test::RobosensePacket data(model);
  data.set_azimuths(35950, 20, options.range_unit_m ? 2 : 1);
  for (std::size_t slot = 0; slot < 32; ++slot) data.set_return(3, slot, 1000);
  const auto unit = landfix::test::robosense_unit(model);
  std::array<std::vector<std::byte>, 2> packets{
      std::vector<std::byte>(data.bytes().begin(), data.bytes().end()),
      std::vector<std::byte>(unit.bytes().begin(), unit.bytes().end())};

  std::vector<Point> storage(4000);
  SweepPair sweeps(storage);
  AnyDecoder decoder = landfix::drivers::make_decoder(*landfix::drivers::find_sensor_model(model), options);
  std::int64_t receive_utc_ns = landfix::test::RobosensePacket::kTimeUtcNs;
  const auto decode = [&](std::span<const std::byte> payload) {
    receive_utc_ns += 1'000'000;
    static_cast<void>(decoder.decode({.payload = payload, .receive_utc_ns = receive_utc_ns}, sweeps));
    for (const Point& point : sweeps.current().points()) {
      if (!std::isfinite(point.x + point.y + point.z) || point.time_s < 0.0F || point.ring >= 32)
        std::abort();
    }
  };
  decode(input);
  decode(packets[1]);
  // Each change: where (two bytes), what (one byte), and which packet is then complete, if any.
  for (; input.size() >= 4; input = input.subspan(4)) {
    const auto choice = std::to_integer<unsigned>(input[3]);
    auto& packet = packets[choice % 2];
    const auto at = std::to_integer<std::size_t>(input[0]) + 256 * std::to_integer<std::size_t>(input[1]);
    packet[at % packet.size()] = input[2];
    if (choice / 2 % 4 == 0) decode(packet);
  }
  static_cast<void>(decoder.flush(sweeps));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto input = std::as_bytes(std::span(data, size)).subspan(1);
  switch (data[0] % 4) {
    case 0:
      fuzz("rs32", {}, input);
      break;
    case 1:
      fuzz("rs32", {.range_unit_m = 0.01}, input);
      break;
    case 2:
      fuzz("rs16", {}, input);
      break;
    default:
      fuzz("helios16p", {}, input);
      break;
  }
  return 0;
}
