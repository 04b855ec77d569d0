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
#include "drivers/velodyne/hdl64_wire.hpp"

namespace landfix::drivers::velodyne {

class Hdl64Projector {
 public:
  static constexpr std::size_t kLasersPerBlock = 32;

  explicit Hdl64Projector(const DecoderOptions& options) noexcept;

  /// Ranks the rings and computes all that depends on the lasers.
  void set_calibration(const Hdl64Calibration& calibration) noexcept;
  /// Cheap where the layout is the same and no laser fires kLeastTurnRad or more from where it did.
  void set_rotation(Hdl64Layout layout, double rad_per_s) noexcept;

  struct Block {
    const std::byte* slots = nullptr;       ///< 32 x 3 bytes
    const std::byte* duplicates = nullptr;  ///< of the other return: equal ranges are dropped; may be null
    std::size_t first_laser = 0;            ///< 0 or 32
    std::uint16_t azimuth_centideg = 0;
    float time_s = 0.0F;  ///< of the block's first firing, since the start of the sweep
  };
  /// Appends the points of a block, in the order of its slots.
  void project(const Block& block, Sweep& sweep) const noexcept;

 private:
  template <class T>
  using PerLaser = std::array<T, kHdl64Lasers>;

  void set_laser(std::size_t i, const Hdl64Laser& laser, bool correct_intensity) noexcept;
  void turn_on() noexcept;
  /// `points` has room for kLasersPerBlock.
  [[nodiscard]] SlotPoints project_lasers(const Block& block, std::span<Point> points) const noexcept;

  double min_range_m_;
  double max_range_m_;
  bool firing_time_azimuth_;
  bool two_point_correction_;
  bool vertical_offsets_;
  Hdl64Layout layout_ = Hdl64Layout::single;
  double turn_rate_rad_per_s_ = 0.0;

  PerLaser<double> rotation_rad_{};
  alignas(32) PerLaser<std::uint32_t> ring_{};
  alignas(
      32) PerLaser<std::uint32_t> least_raw_{};  ///< ranges that are kept: none of a laser that is disabled
  alignas(32) PerLaser<std::uint32_t> most_raw_{};
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
