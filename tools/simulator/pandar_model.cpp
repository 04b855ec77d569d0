#include "tools/simulator/pandar_model.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tools/simulator/pandar_packets.hpp"
#include "tools/simulator/pandar_tables.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/wire_bytes.hpp"

namespace landfix::tools::simulator {
namespace {

/// A block is one firing of all lasers; its azimuth is where the rotor is at its end.
constexpr std::int64_t kBlock_ns = 55'560;
/// Where the beams start, in the frame of the rotor: x forward, y left.
constexpr double kCentreForward_m = 0.03873;
constexpr double kCentreLeft_m = 0.012;
constexpr double kPandarRangeUnit_m = 0.004;

constexpr LidarTraits traits_of(std::string_view name, std::size_t blocks, std::size_t channels) noexcept {
  return {.name = name,
          .data_port = 2368,
          .telemetry_port = 10110,
          .packet_ns = static_cast<std::int64_t>(blocks) * kBlock_ns,
          .shots_per_packet = blocks * channels,
          .min_range_m = 0.3,
          .max_range_m = 200.0,
          .range_sigma_m = 0.007};  // the data sheet's +-2 cm, read as 3 sigma
}

/// The angles of one unit: they differ from the model's by some hundredths of a degree, channel by channel,
/// and all together by how the optics sit. Thousandths are what its file holds.
double of_unit_deg(double model_deg, double together_deg, std::uint64_t seed, std::size_t channel) noexcept {
  constexpr double kApart_deg = 0.03;
  const double apart_deg =
      kApart_deg * (2.0 * to_unit(random_bits(seed, RandomStream::world, channel)) - 1.0);
  return std::round(1000.0 * (model_deg + together_deg + apart_deg)) / 1000.0;
}

template <std::size_t N>
std::vector<PandarChannel> unit_of(const std::array<PandarChannel, N>& model) {
  constexpr std::uint64_t kElevationSeed = 64;
  constexpr std::uint64_t kAzimuthSeed = 40;
  constexpr double kTilt_deg = -0.06;
  std::vector<PandarChannel> unit(model.begin(), model.end());
  for (std::size_t i = 0; i < N; ++i) {
    unit[i].elevation_deg = of_unit_deg(model[i].elevation_deg, kTilt_deg, kElevationSeed, i);
    unit[i].azimuth_offset_deg = of_unit_deg(model[i].azimuth_offset_deg, 0.0, kAzimuthSeed, i);
  }
  return unit;
}

class PandarModel final : public LidarModel {
 public:
  PandarModel(const LidarTraits& traits, const pandar::Form& form, std::vector<PandarChannel> unit)
      : traits_(traits), form_(form), unit_(std::move(unit)) {}

  [[nodiscard]] const LidarTraits& traits() const noexcept override { return traits_; }

  void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept override {
    for (std::size_t i = 0; i < traits_.shots_per_packet; ++i) {
      const PandarChannel& channel = unit_[i % unit_.size()];
      const auto block_end_ns = static_cast<std::int64_t>(i / unit_.size() + 1) * kBlock_ns;
      const std::int64_t after_ns = block_end_ns + std::llround(1e3 * channel.firing_time_us);
      const double rotor_deg = rotor_angle_deg(utc_ns + after_ns);
      const double sine = std::sin(rotor_deg * std::numbers::pi / 180.0);
      const double cosine = std::cos(rotor_deg * std::numbers::pi / 180.0);
      shots[i] = {.after_ns = after_ns,
                  .azimuth_deg = rotor_deg + channel.azimuth_offset_deg,
                  .elevation_deg = channel.elevation_deg,
                  .origin_m = {kCentreForward_m * cosine + kCentreLeft_m * sine,
                               kCentreLeft_m * cosine - kCentreForward_m * sine, 0.0},
                  .laser = i % unit_.size()};
    }
  }

  [[nodiscard]] std::vector<std::byte> encode(std::uint64_t packet, std::int64_t utc_ns,
                                              std::span<const Echo> echoes) const override {
    std::vector<Shot> shots(traits_.shots_per_packet);
    aim(utc_ns, shots);
    pandar::DataPacket payload(form_);
    for (std::size_t i = 0; i < shots.size(); ++i) {
      if (echoes[i].range_m == 0.0) continue;
      // The sensor measures from its centre, although the beam starts beside it.
      const double range_m = (shots[i].origin_m + echoes[i].range_m * shots[i].direction()).norm();
      payload.put_return(i / unit_.size(), i % unit_.size(), to_range_raw(range_m, kPandarRangeUnit_m),
                         echoes[i].reflectivity);
    }
    for (std::size_t block = 0; block < form_.blocks; ++block) {
      const std::int64_t block_end_ns = static_cast<std::int64_t>(block + 1) * kBlock_ns;
      payload.put_azimuth(block, rotor_angle_centideg(utc_ns + block_end_ns));
    }
    payload.put_time(utc_ns + traits_.packet_ns + form_.packing_ns);
    if (form_.numbered) payload.put_sequence(static_cast<std::uint32_t>(packet));
    return payload.take();
  }

  [[nodiscard]] std::vector<std::byte> encode_telemetry(const GpsFix& fix) const override {
    return pandar::gps_packet(fix);
  }

  [[nodiscard]] std::optional<CalibrationFile> calibration() const override {
    std::string text = "Laser id,Elevation,Azimuth\n";
    for (std::size_t i = 0; i < unit_.size(); ++i) {
      text += fmt::format("{},{:.3f},{:.3f}\n", i + 1, unit_[i].elevation_deg, unit_[i].azimuth_offset_deg);
    }
    return CalibrationFile{.name = "angle-correction.csv", .text = std::move(text)};
  }

 private:
  LidarTraits traits_;
  pandar::Form form_;
  std::vector<PandarChannel> unit_;
};

}  // namespace

std::unique_ptr<LidarModel> make_pandar(PandarVariant variant) {
  if (variant == PandarVariant::pandar40p) {
    return std::make_unique<PandarModel>(traits_of("pandar40p", pandar::kPandar40p.blocks, 40),
                                         pandar::kPandar40p, unit_of(kPandar40pChannels));
  }
  return std::make_unique<PandarModel>(traits_of("pandar64", pandar::kPandar64.blocks, 64), pandar::kPandar64,
                                       unit_of(kPandar64Channels));
}

}  // namespace landfix::tools::simulator
