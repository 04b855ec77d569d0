// The decoder of whichever sensor there is: the choice is made once a packet, not once a point.
#pragma once

#include <optional>
#include <variant>

#include "drivers/decoder.hpp"
#include "drivers/hesai/pandar_decoder.hpp"
#include "drivers/ouster/ouster_decoder.hpp"
#include "drivers/robosense/decoder.hpp"
#include "drivers/velodyne/block_decoder.hpp"
#include "drivers/velodyne/hdl64_decoder.hpp"
#include "drivers/velodyne/vls128_decoder.hpp"

namespace landfix::drivers {

/// Made by make_decoder (drivers/make_decoder.hpp).
class AnyDecoder {
 public:
  using Alternatives = std::variant<velodyne::BlockDecoder, velodyne::Vls128Decoder, velodyne::Hdl64Decoder,
                                    hesai::PandarDecoder, ouster::OusterDecoder, robosense::Decoder>;

  explicit AnyDecoder(const Alternatives& decoder) noexcept : decoder_(decoder) {}

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept;
  [[nodiscard]] const StreamCounters& counters() const noexcept;

  /// Where the receiver at the sensor says it is, by the latest position packet. Nothing if it has no fix, or
  /// the sensor's packets hold none.
  [[nodiscard]] std::optional<velodyne::PositionFix> position() const noexcept;

 private:
  Alternatives decoder_;
};
static_assert(PacketDecoder<AnyDecoder>);

}  // namespace landfix::drivers
