#include "drivers/ouster/column_projector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/little_endian.hpp"

namespace landfix::drivers::ouster {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr float kMetresPerMillimetre = 0.001F;
constexpr double kMostMm = 4e9;

}  // namespace

ColumnProjector::ColumnProjector(const Metadata& metadata, const DecoderOptions& options) noexcept
    : rows_(std::min(metadata.row_count, kMaxRows)) {
  constexpr auto kProjects = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Project, kProfiles.size()>{&ColumnProjector::project_as<kProfiles[I].pixel>...};
  }
  (std::make_index_sequence<kProfiles.size()>());
  project_ = kProjects[static_cast<std::size_t>(metadata.profile)];

  const double least_mm = std::clamp(std::ceil(options.min_range_m * 1e3 - 1e-6), 1.0, kMostMm);
  const double most_mm = std::clamp(std::floor(options.max_range_m * 1e3 + 1e-6), least_mm, kMostMm);
  least_mm_ = static_cast<std::uint32_t>(least_mm);
  most_less_least_mm_ = static_cast<std::uint32_t>(most_mm - least_mm);

  for (std::size_t i = 0; i < rows_; ++i) {
    const Row& row = metadata.rows[i];
    // Azimuths of beams count clockwise, encoder angles counter-clockwise.
    const double azimuth_rad = -row.azimuth_deg * kRadPerDeg;
    const double altitude_rad = row.altitude_deg * kRadPerDeg;
    range_mask_[i] = row.present ? pixel_of(metadata.profile).range_mask : 0;
    ring_[i] = row.ring;
    direction_x_[i] = static_cast<float>(std::cos(altitude_rad) * std::cos(azimuth_rad));
    direction_y_[i] = static_cast<float>(std::cos(altitude_rad) * std::sin(azimuth_rad));
    direction_z_[i] = static_cast<float>(std::sin(altitude_rad));
  }

  // The range that the sensor reports includes the way from the axis to the beam's exit.
  const double x_mm = metadata.beam_origin_x_mm;
  const double z_mm = metadata.beam_origin_z_mm;
  along_offset_m_ = static_cast<float>(1e-3 * (z_mm == 0.0 ? x_mm : std::hypot(x_mm, z_mm)));
  origin_x_m_ = static_cast<float>(1e-3 * x_mm);
  origin_z_m_ = static_cast<float>(1e-3 * z_mm);
  for (std::size_t i = 0; i < 12; ++i) {
    const double unit = i % 4 == 3 ? 1e-3 : 1.0;
    lidar_to_sensor_[i / 4][i % 4] = static_cast<float>(unit * metadata.lidar_to_sensor[i]);
  }

  for (std::size_t column = 0; column < metadata.columns_per_frame; ++column) {
    const double angle_rad =
        2.0 * std::numbers::pi *
        (1.0 - static_cast<double>(column) / static_cast<double>(metadata.columns_per_frame));
    turns_[column] = {.cosine = static_cast<float>(std::cos(angle_rad)),
                      .sine = static_cast<float>(std::sin(angle_rad))};
  }
}

void ColumnProjector::project(const std::byte* pixels, std::size_t column, float time_s,
                              Sweep& sweep) const noexcept {
  (this->*project_)(pixels, column, time_s, sweep);
}

void ColumnProjector::place(Turn turn, Returns& returns) const noexcept {
  // One matrix a column: lidar_to_sensor times the turn of the encoder.
  struct Line {
    float x, y, z, origin;
  };
  const auto line = [&](const std::array<float, 4>& m) {
    const Line turned{.x = m[0] * turn.cosine + m[1] * turn.sine,
                      .y = m[1] * turn.cosine - m[0] * turn.sine,
                      .z = m[2],
                      .origin = m[3]};
    return Line{turned.x, turned.y, turned.z,
                turned.origin + turned.x * origin_x_m_ + turned.z * origin_z_m_};
  };
  const Line x = line(lidar_to_sensor_[0]);
  const Line y = line(lidar_to_sensor_[1]);
  const Line z = line(lidar_to_sensor_[2]);
  const std::size_t rows = rows_;
  for (std::size_t i = 0; i < rows; ++i) {
    // Ranges have 20 bits at most: the conversion from a signed integer is the one that vectorises.
    const float along_m =
        static_cast<float>(static_cast<std::int32_t>(returns.range_mm[i])) * kMetresPerMillimetre -
        along_offset_m_;
    const float forward = direction_x_[i];
    const float left = direction_y_[i];
    const float up = direction_z_[i];
    returns.x[i] = x.origin + along_m * (x.x * forward + x.y * left + x.z * up);
    returns.y[i] = y.origin + along_m * (y.x * forward + y.y * left + y.z * up);
    returns.z[i] = z.origin + along_m * (z.x * forward + z.y * left + z.z * up);
  }
}

template <PixelLayout Layout>
void ColumnProjector::project_as(const std::byte* pixels, std::size_t column, float time_s,
                                 Sweep& sweep) const noexcept {
  constexpr std::size_t kReturns = Layout.returns();
  const std::size_t rows = rows_;
  std::array<Returns, kReturns> returns;
  for (std::size_t k = 0; k < kReturns; ++k) {
    const std::byte* const words = pixels + k * Layout.second_at;
    for (std::size_t i = 0; i < rows; ++i) {
      const auto word = load_little_endian<std::uint32_t>(words + i * Layout.bytes);
      returns[k].range_mm[i] = (word & range_mask_[i]) << Layout.range_shift;
    }
    place(turns_[column], returns[k]);
  }

  const auto point = [&](std::size_t k, std::size_t i) {
    const std::byte reflectivity = pixels[i * Layout.bytes + Layout.reflectivity_at + k * Layout.second_at];
    return Point{.x = returns[k].x[i],
                 .y = returns[k].y[i],
                 .z = returns[k].z[i],
                 .intensity = static_cast<float>(std::to_integer<std::uint8_t>(reflectivity)),
                 .time_s = time_s,
                 .ring = ring_[i]};
  };
  // A second return equal to the first is the same one.
  const auto counts = [&](std::size_t k, std::size_t i) {
    return admits(returns[k].range_mm[i]) && (k == 0 || returns[k].range_mm[i] != returns[0].range_mm[i]);
  };
  const std::span<Point> room = sweep.unused();
  if (room.size() < rows * kReturns) {
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t k = 0; k < kReturns; ++k) {
        if (counts(k, i)) sweep.push(point(k, i));
      }
    }
    return;
  }
  // Every point is written, and the next over it if it does not count: no branch to mispredict.
  std::size_t count = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < kReturns; ++k) {
      room[count] = point(k, i);
      count += static_cast<std::size_t>(counts(k, i));
    }
  }
  sweep.take(count, time_s);
}

}  // namespace landfix::drivers::ouster
