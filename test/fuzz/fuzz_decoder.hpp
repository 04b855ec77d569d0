// The input is a sequence of packets: sound ones, with bytes replaced as the fuzzer says, so that it need not
// find a whole packet by chance; or its own bytes as they are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "drivers/make_decoder.hpp"

namespace landfix::test {

/// What the packets of an input are made of. To build one costs more than to decode a packet: build it once,
/// every input decodes with a copy.
struct FuzzedSensor {
  FuzzedSensor(const char* name, std::vector<std::vector<std::byte>> sound_packets,
               const drivers::Calibration& calibration = {}, const drivers::DecoderOptions& options = {},
               std::int64_t start_utc_ns = 1'700'000'000'000'000'000)
      : model(*drivers::find_sensor_model(name)),
        sound(std::move(sound_packets)),
        decoder(drivers::make_decoder(model, options, calibration)),
        receive_utc_ns(start_utc_ns) {}

  /// Every input begins when the telemetry has been heard.
  void hear_telemetry() {
    std::array<drivers::Point, 2> storage;
    drivers::SweepPair sweeps(storage);
    for (const auto& packet : std::span(sound).subspan(1)) {
      const auto result = decoder.decode({.payload = packet, .receive_utc_ns = receive_utc_ns}, sweeps);
      if (result.status != drivers::DecodeStatus::telemetry) std::abort();
    }
  }

  const drivers::SensorModel& model;
  std::vector<std::vector<std::byte>> sound;  ///< a data packet, then telemetry
  drivers::AnyDecoder decoder;
  std::int64_t receive_utc_ns;
};

/// A copy of a packet as it comes from the network.
inline std::vector<std::byte> to_bytes(std::span<const std::byte> packet) {
  return {packet.begin(), packet.end()};
}

/// Decodes packets, and aborts where a decoder breaks a promise: its points are finite, of a beam there is,
/// and not before their sweep; a packet that is refused changes no sweep.
class DecoderChecker {
 public:
  explicit DecoderChecker(const FuzzedSensor& sensor)
      : model_(sensor.model), decoder_(sensor.decoder), receive_utc_ns_(sensor.receive_utc_ns) {}

  void decode(std::span<const std::byte> payload) {
    using drivers::DecodeStatus;
    static_cast<void>(drivers::looks_like(model_, payload));
    receive_utc_ns_ += 1'000'000;
    const auto [status, completed] =
        decoder_.decode({.payload = payload, .receive_utc_ns = receive_utc_ns_}, sweeps_);
    if (completed) {
      check(sweeps_.completed().points());
      checked_ = 0;
    }
    const auto points = sweeps_.current().points();
    if (status != DecodeStatus::decoded && (completed || points.size() != checked_)) std::abort();
    check(points.subspan(std::min(checked_, points.size())));
    checked_ = points.size();
  }

  void flush() {
    if (decoder_.flush(sweeps_)) check(sweeps_.completed().points());
  }

 private:
  void check(std::span<const drivers::Point> points) const {
    for (const drivers::Point& point : points) {
      const bool sound = std::isfinite(point.x + point.y + point.z) && point.time_s >= 0.0F;
      if (!sound || point.ring >= model_.beam_count) std::abort();
    }
  }

  const drivers::SensorModel& model_;
  drivers::AnyDecoder decoder_;
  std::int64_t receive_utc_ns_;
  std::array<drivers::Point, 200> storage_{};  ///< of a few packets with 32 returns: sweeps overflow too
  drivers::SweepPair sweeps_{storage_};
  std::size_t checked_ = 0;  ///< points of the current sweep
};

inline void fuzz_decoder(const FuzzedSensor& sensor, std::span<const std::byte> input) {
  static std::optional<DecoderChecker> only;  // too large for the stack to be cheap
  DecoderChecker& checker = only.emplace(sensor);
  checker.decode(input);
  // Each change: where (two bytes), what (one byte), and which packet is then complete, if any.
  auto packets = sensor.sound;
  for (; input.size() >= 4; input = input.subspan(4)) {
    const auto choice = std::to_integer<std::size_t>(input[3]);
    auto& packet = packets[choice % packets.size()];
    const auto at = std::to_integer<std::size_t>(input[0]) + 256 * std::to_integer<std::size_t>(input[1]);
    packet[at % packet.size()] = input[2];
    if (choice == 0xFF) checker.decode(to_bytes(std::span(packet).first(at % packet.size())));  // cut short
    if (choice / packets.size() % 4 == 0) checker.decode(packet);
  }
  checker.flush();
}

}  // namespace landfix::test
