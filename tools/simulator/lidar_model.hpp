// A sensor as the simulator knows it: when and where its lasers fire, and how it writes down what comes back.
// Each model is written from the maker's documents with tables of its own, never from the decoders, so that
// a slip in a decoder's table cannot cancel out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace landfix::tools::simulator {

/// One laser, fired once. Frame `sensor`: x forward, y left, z up.
struct Shot {
  std::int64_t after_ns = 0;  ///< since the moment of the packet
  double azimuth_deg = 0.0;   ///< where it points, clockwise from the front, offsets and rotation included
  double elevation_deg = 0.0;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< where it starts
  std::size_t laser = 0;                               ///< of the sensor, less than kMostLasers

  [[nodiscard]] Eigen::Vector3d direction() const noexcept;
};

inline constexpr std::size_t kMostLasers = 128;

/// What comes back of a shot, as exactly as the sensor knows it: the wire's resolution is for the encoder.
struct Echo {
  double range_m = 0.0;  ///< from the shot's origin; 0: none
  std::uint8_t reflectivity = 0;
};

struct LidarTraits {
  std::string_view name;  ///< as on the command line
  std::uint16_t data_port = 0;
  std::uint16_t telemetry_port = 0;  ///< 0: it sends none
  std::int64_t packet_ns = 0;        ///< from one packet to the next
  std::size_t shots_per_packet = 0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double range_sigma_m = 0.0;         ///< noise, one standard deviation; as much differ the lasers of a unit
  double elevation_sigma_deg = 0.01;  ///< by which the lasers of a unit differ from what is said of them
};

/// What the GPS receiver at the sensor says.
struct GpsFix {
  std::int64_t utc_ns = 0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double speed_mps = 0.0;
  double course_deg = 0.0;  ///< clockwise from north
};

/// What comes with one unit of a sensor, to be named in the configuration.
struct CalibrationFile {
  std::string name;
  std::string text;
};

/// Every function is thread-safe and gives the same answer to the same question.
class LidarModel {
 public:
  LidarModel() = default;
  LidarModel(const LidarModel&) = delete;
  LidarModel& operator=(const LidarModel&) = delete;
  virtual ~LidarModel() = default;

  [[nodiscard]] virtual const LidarTraits& traits() const noexcept = 0;

  /// The shots of the packet whose moment is `utc_ns`, in the order of the wire; `shots` has room for
  /// `shots_per_packet`.
  virtual void aim(std::int64_t utc_ns, std::span<Shot> shots) const noexcept = 0;

  /// The payload that reports `echoes`, one a shot. `packet` counts from 0.
  [[nodiscard]] virtual std::vector<std::byte> encode(std::uint64_t packet, std::int64_t utc_ns,
                                                      std::span<const Echo> echoes) const = 0;

  /// What the sensor sends to its telemetry port, once a second: position, status, calibration.
  [[nodiscard]] virtual std::vector<std::byte> encode_telemetry(const GpsFix& /*fix*/) const { return {}; }

  /// Nothing where the packets say it all.
  [[nodiscard]] virtual std::optional<CalibrationFile> calibration() const { return std::nullopt; }
};

/// In the order of the catalogue.
[[nodiscard]] std::vector<std::string_view> lidar_model_names();

/// Throws std::invalid_argument, with the names there are.
[[nodiscard]] std::unique_ptr<LidarModel> make_lidar_model(std::string_view name);

/// Where a rotor points at 600 rpm, clockwise from the front [deg]. It is locked to the second, as with a
/// sensor's phase lock at 0 deg.
[[nodiscard]] constexpr double rotor_angle_deg(std::int64_t utc_ns) noexcept {
  constexpr std::int64_t kTurn_ns = 100'000'000;
  return 360.0 * static_cast<double>(utc_ns % kTurn_ns) / static_cast<double>(kTurn_ns);
}

/// The same as a sensor writes it, 0 to 35999.
[[nodiscard]] std::uint16_t rotor_angle_centideg(std::int64_t utc_ns) noexcept;

}  // namespace landfix::tools::simulator
