// HDL-64E S1, S2 and S3: 64 lasers in two blocks that only the unit's own calibration makes points of. The
// S2 and S3 send it with their packets; until it has come, packets give no points.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/decoder.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sweep_builder.hpp"
#include "drivers/velodyne/hdl64_calibration.hpp"
#include "drivers/velodyne/hdl64_clock.hpp"
#include "drivers/velodyne/hdl64_projector.hpp"
#include "drivers/velodyne/hdl64_status.hpp"
#include "drivers/velodyne/hdl64_wire.hpp"
#include "drivers/velodyne/spin_rate.hpp"

namespace landfix::drivers::velodyne {

enum class Hdl64Generation : std::uint8_t { s1, s2, s3 };

class Hdl64Decoder {
 public:
  /// `calibration`: of the unit's file; null where its packets bring it.
  Hdl64Decoder(Hdl64Generation generation, const Hdl64Calibration* calibration,
               const DecoderOptions& options) noexcept;

  [[nodiscard]] DecodeResult decode(const Packet& packet, SweepPair& sweeps) noexcept;
  [[nodiscard]] bool flush(SweepPair& sweeps) noexcept { return builder_.flush(sweeps); }
  [[nodiscard]] const StreamCounters& counters() const noexcept { return builder_.counters(); }

 private:
  /// What a packet says, once it is known to be sound.
  struct Header {
    Hdl64Layout layout{};
    std::array<std::uint16_t, kBlocks> firing_azimuth_centideg{};
    std::size_t firings = 0;
    std::uint32_t top_of_hour_us = 0;
  };
  [[nodiscard]] DecodeStatus validate(std::span<const std::byte> payload, Header& header) const noexcept;
  void measure_rotation(const Header& header) noexcept;
  void read_status(std::span<const std::byte> payload, std::int64_t sensor_ns,
                   std::int64_t receive_utc_ns) noexcept;
  void project_firing(std::span<const std::byte> payload, const Header& header, std::size_t firing,
                      float time_s, Sweep& sweep) const noexcept;

  Hdl64Projector projector_;
  SweepBuilder builder_;
  SpinRate spin_rate_;
  Hdl64S1Clock s1_clock_;
  Hdl64SetCollector collector_;
  Hdl64Calendar calendar_;
  Hdl64Calibration calibration_;
  Hdl64Generation generation_;
  bool from_file_;
  bool calibrated_;
  bool time_is_packet_end_;
  bool rotation_is_known_ = false;
};
static_assert(PacketDecoder<Hdl64Decoder>);

}  // namespace landfix::drivers::velodyne
