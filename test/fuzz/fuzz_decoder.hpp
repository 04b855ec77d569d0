// The input is a sequence of packets: sound ones, with bytes replaced as the fuzzer says, so that it need not
// find a whole packet by chance; or its own bytes as they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/decoder.hpp"
#include "drivers/make_decoder.hpp"

namespace landfix::test {

inline void fuzz_decoder(const char* model, std::span<const std::byte> sound,
                         std::span<const std::byte> input, const drivers::Calibration& calibration = {}) {
  std::vector<drivers::Point> storage(4000);
  drivers::SweepPair sweeps(storage);
  drivers::AnyDecoder decoder = drivers::make_decoder(*drivers::find_sensor_model(model), {}, calibration);
  std::int64_t receive_utc_ns = 1'700'000'000'000'000'000;
  const auto decode = [&](std::span<const std::byte> payload) {
    receive_utc_ns += 1'000'000;
    static_cast<void>(decoder.decode({.payload = payload, .receive_utc_ns = receive_utc_ns}, sweeps));
    for (const drivers::Point& point : sweeps.current().points()) {
      if (!std::isfinite(point.x + point.y + point.z) || point.time_s < 0.0F) std::abort();
    }
  };
  decode(input);
  // Each change: where (two bytes), what (one byte), and whether the packet is then complete.
  std::vector<std::byte> packet(sound.begin(), sound.end());
  for (; input.size() >= 4; input = input.subspan(4)) {
    const auto at = std::to_integer<std::size_t>(input[0]) + 256 * std::to_integer<std::size_t>(input[1]);
    packet[at % packet.size()] = input[2];
    if (std::to_integer<unsigned>(input[3]) % 4 == 0) decode(packet);
  }
  static_cast<void>(decoder.flush(sweeps));
}

}  // namespace landfix::test
