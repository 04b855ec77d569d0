// From the pixels of a column to points. What depends on the row alone is computed once, what depends on the
// column once a column; a return costs a dozen multiplications.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/decoder_options.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/sweep.hpp"

namespace landfix::drivers::ouster {

/// The vendor's sensor frame is ours: x forward, away from the connector, y left, z up, origin at the centre
/// of the base. The lidar frame, in which the encoder counts, looks backwards (x towards the connector) and
/// lies higher, on the axis of rotation in the optical plane: `lidar_to_sensor` of the unit's metadata leads
/// from it to the sensor frame.
class ColumnProjector {
 public:
  ColumnProjector(const Metadata& metadata, const DecoderOptions& options) noexcept;

  /// Appends the returns of a column, in the order of the wire: row by row, the second return of a pixel
  /// after the first. `pixels` holds the metadata's rows; `column` is less than its columns per frame.
  void project(const std::byte* pixels, std::size_t column, float time_s, Sweep& sweep) const noexcept;

 private:
  template <class T>
  using PerRow = std::array<T, kMaxRows>;
  /// One return of each row.
  struct Returns {
    alignas(32) PerRow<std::uint32_t> range_mm;
    alignas(32) PerRow<float> x;
    alignas(32) PerRow<float> y;
    alignas(32) PerRow<float> z;
  };
  struct Turn {
    float cosine = 1.0F;
    float sine = 0.0F;
  };

  template <PixelLayout Layout>
  void project_as(const std::byte* pixels, std::size_t column, float time_s, Sweep& sweep) const noexcept;
  /// x, y and z from the ranges.
  void place(Turn turn, Returns& returns) const noexcept;
  [[nodiscard]] bool admits(std::uint32_t range_mm) const noexcept {
    return range_mm - least_mm_ <= most_less_least_mm_;
  }

  using Project = void (ColumnProjector::*)(const std::byte*, std::size_t, float, Sweep&) const noexcept;
  Project project_;

  std::size_t rows_;
  std::uint32_t least_mm_ = 1;  // 0 is no return
  std::uint32_t most_less_least_mm_ = 0;
  /// Of the range's word; nothing of a row without a beam.
  alignas(32) PerRow<std::uint32_t> range_mask_{};
  PerRow<std::uint16_t> ring_{};

  // Of the beam at encoder angle 0, in the lidar frame; the beam's origin is the same of all.
  alignas(32) PerRow<float> direction_x_{};
  alignas(32) PerRow<float> direction_y_{};
  alignas(32) PerRow<float> direction_z_{};
  float along_offset_m_ = 0.0F;  ///< ranges begin before the beam does
  float origin_x_m_ = 0.0F;
  float origin_z_m_ = 0.0F;
  std::array<std::array<float, 4>, 3> lidar_to_sensor_{};  ///< translation in metres

  std::array<Turn, kMaxColumnsPerFrame> turns_{};  ///< encoder angle of each column
};

}  // namespace landfix::drivers::ouster
