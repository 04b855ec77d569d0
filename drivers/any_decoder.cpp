#include "drivers/any_decoder.hpp"

namespace landfix::drivers {

DecodeResult AnyDecoder::decode(const Packet& packet, SweepPair& sweeps) noexcept {
  return std::visit([&](auto& decoder) noexcept { return decoder.decode(packet, sweeps); }, decoder_);
}

bool AnyDecoder::flush(SweepPair& sweeps) noexcept {
  return std::visit([&](auto& decoder) noexcept { return decoder.flush(sweeps); }, decoder_);
}

const StreamCounters& AnyDecoder::counters() const noexcept {
  return std::visit([](const auto& decoder) noexcept -> const StreamCounters& { return decoder.counters(); },
                    decoder_);
}

std::optional<velodyne::PositionFix> AnyDecoder::position() const noexcept {
  return std::visit(
      [](const auto& decoder) noexcept -> std::optional<velodyne::PositionFix> {
        if constexpr (requires { decoder.position(); }) return decoder.position();
        return std::nullopt;
      },
      decoder_);
}

}  // namespace landfix::drivers
