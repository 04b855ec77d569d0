// The geometry of the HDL-64E: a block of 32 returns becomes points, each range corrected by where the beam
// points and how far it reaches (HDL-64E S2 and S2.1 User's Manual, appendices D and F). What depends on the
// laser alone is computed once, on the speed of rotation once a packet, on the azimuth once a block; the rest
// is straight arithmetic without a branch.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/block_projector.hpp"
#include "drivers/decoder_options.hpp"
#include "drivers/sweep.hpp"
#include "drivers/velodyne/hdl64_calibration.hpp"

namespace landfix::drivers::velodyne {

/// When the lasers of a block fire, since the first of them.
enum class Hdl64Timing : std::uint8_t {
  single,  ///< S2 and S3: 48 us, upper and lower block together
  dual,    ///< S3 with two returns: 57.6 us
  s1,      ///< one block after the other, 32 us each
};

class Hdl64Projector {
 public:
  static constexpr std::size_t kLasersPerBlock = 32;

  explicit Hdl64Projector(const DecoderOptions& options) noexcept;

  /// Ranks the rings and computes all that depends on the lasers.
  void set_calibration(const Hdl64Calibration& calibration) noexcept;
  /// Cheap where neither has changed (the speed by more than one part in 10,000).
  void set_rotation(Hdl64Timing timing, double rad_per_s) noexcept;

  /// Where the rotor points; the blocks of a firing share it.
  struct Heading {
    float cosine = 1.0F;
    float sine = 0.0F;
  };
  [[nodiscard]] static Heading heading(std::uint16_t azimuth_centideg) noexcept;

  struct Block {
    const std::byte* slots = nullptr;       ///< 32 x 3 bytes
    const std::byte* duplicates = nullptr;  ///< of the other return: equal ranges are dropped; may be null
    std::size_t first_laser = 0;            ///< 0 or 32
    Heading heading;
    float time_s = 0.0F;  ///< of the block's first firing, since the start of the sweep
  };
  /// Appends the points of a block, in the order of its slots.
  void project(const Block& block, Sweep& sweep) const noexcept;

 private:
  template <class T>
  using PerLaser = std::array<T, kHdl64Lasers>;

  void set_laser(std::size_t i, const Hdl64Laser& laser, bool correct_intensity) noexcept;
  void turn_on() noexcept;
  [[nodiscard]] std::size_t write_points(const Block& block,
                                         std::span<Point, kLasersPerBlock> points) const noexcept;

  double min_range_m_;
  double max_range_m_;
  bool firing_time_azimuth_;
  bool two_point_correction_;
  bool vertical_offsets_;
  Hdl64Timing timing_ = Hdl64Timing::single;
  double turn_rate_rad_per_s_ = 0.0;

  PerLaser<double> rotation_rad_{};
  PerLaser<std::uint16_t> ring_{};
  PerLaser<RangeGate> gate_{};  ///< admits nothing of a laser that is disabled
  // The correction that replaces `range_m` within 25.04 m: at_axis + growth * distance, to the side and
  // ahead.
  alignas(32) PerLaser<float> range_m_{};
  alignas(32) PerLaser<float> side_at_axis_m_{};
  alignas(32) PerLaser<float> side_growth_{};
  alignas(32) PerLaser<float> ahead_at_axis_m_{};
  alignas(32) PerLaser<float> ahead_growth_{};
  alignas(32) PerLaser<float> cos_elevation_{};
  alignas(32) PerLaser<float> sin_elevation_{};
  alignas(32) PerLaser<float> vertical_offset_m_{};
  alignas(32) PerLaser<float> horizontal_offset_m_{};
  // The correction of the intensity: slope * |focus - 256 (1 - raw / 65535)^2|.
  alignas(32) PerLaser<float> focal_slope_{};
  alignas(32) PerLaser<float> focus_{};
  alignas(32) PerLaser<float> min_intensity_{};
  alignas(32) PerLaser<float> max_intensity_{};
  // Of the direction of the laser at azimuth 0, turned on by its firing time.
  alignas(32) PerLaser<float> cosine_{};
  alignas(32) PerLaser<float> sine_{};
  alignas(32) PerLaser<float> time_s_{};
};

}  // namespace landfix::drivers::velodyne
