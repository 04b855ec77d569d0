#include "ndt/reach.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ndt/objective.hpp"

namespace landfix::ndt {
namespace {

constexpr double kLongestWay_m = 150.0;
constexpr double kAcceleration_mps2 = 1.5;
constexpr double kNear_m = 3.0;
constexpr double kTightestCurve_m = 6.0;
constexpr double kUsualCurve_m = 12.0;

/// The voxel of a cell; null where there is none.
[[nodiscard]] const Voxel* voxel_of(const VoxelMap& map, const Cell& cell) noexcept {
  const BlockEntry* const block = map.find_block(block_key(cell));
  if (block == nullptr) return nullptr;
  const std::uint64_t bit = std::uint64_t{1} << cell_bit(cell);
  if ((block->occupancy & bit) == 0) return nullptr;
  return &map.voxels()[block->first_voxel +
                       static_cast<std::size_t>(std::popcount(block->occupancy & (bit - 1)))];
}

/// So far along a straight, a curve by `turn_rad` and a straight; `before`: of the straights, the share of
/// the first.
[[nodiscard]] Eigen::Vector3d along_path(double length_m, double turn_rad, double before) noexcept {
  const double turn = std::abs(turn_rad);
  const double radius_m = turn * kUsualCurve_m <= length_m ? kUsualCurve_m : length_m / turn;
  const double straight_m = std::max(0.0, length_m - radius_m * turn);
  const double first_m = before * straight_m;
  const double last_m = straight_m - first_m;
  const double x_m = first_m + radius_m * std::sin(turn) + last_m * std::cos(turn);
  const double y_m = radius_m * (1.0 - std::cos(turn)) + last_m * std::sin(turn);
  return {x_m, std::copysign(y_m, turn_rad), turn_rad};
}

}  // namespace

std::array<double, 3> GuessSequence::next_fractions() noexcept {
  constexpr std::array<std::uint64_t, 3> kSteps{0xD1B54A32D192ED03U, 0xABC98388FB8FAC03U,
                                                0x8CB92BA72F3D8DD7U};
  std::array<double, 3> fractions;
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    state_[i] += kSteps[i];
    fractions[i] = static_cast<double>(state_[i] >> 11) * 0x1p-53;
  }
  return fractions;
}

Eigen::Vector3d GuessSequence::next_around(double within_m, double heading_rad) noexcept {
  const auto [a, b, c] = next_fractions();
  const double distance_m = within_m * std::sqrt(a);
  const double bearing_rad = 2.0 * std::numbers::pi * b;
  return {distance_m * std::cos(bearing_rad), distance_m * std::sin(bearing_rad),
          2.0 * heading_rad * (c < 0.5 ? c : c - 1.0)};
}

Eigen::Vector3d GuessSequence::next_on_way(double reach_m) noexcept {
  is_path_ = !is_path_;
  if (!is_path_) return next_around(reach_m, std::numbers::pi);
  const auto [a, b, c] = next_fractions();
  const double length_m = reach_m * a;
  // Straight on is the likeliest.
  const double most_rad = std::min(std::numbers::pi, length_m / kTightestCurve_m);
  const double side = 2.0 * b - 1.0;
  return along_path(length_m, most_rad * side * std::abs(side), c);
}

double reach_m(double speed_mps, double duration_s) noexcept {
  const double t = std::max(duration_s, 0.0);
  return std::min(kLongestWay_m, kNear_m + t * (std::abs(speed_mps) + 0.5 * kAcceleration_mps2 * t));
}

std::optional<double> ground_m(const VoxelMap& map, const Eigen::Vector3d& place_m,
                               double within_m) noexcept {
  const Eigen::Vector3d cells = place_m / map.resolution_m();
  if (!has_cell(cells)) return std::nullopt;
  const Cell cell = cell_of(cells);
  const auto most = static_cast<std::int32_t>(std::min(within_m, kLongestWay_m) / map.resolution_m());
  for (std::int32_t away = 0; away <= most; ++away) {
    for (const std::int32_t k : {cell.k - away, cell.k + away}) {
      const Voxel* const voxel = voxel_of(map, {cell.i, cell.j, k});
      if (voxel != nullptr) return k * map.resolution_m() + static_cast<double>(voxel->mean_m[2]);
    }
  }
  return std::nullopt;
}

std::size_t find_floors(const VoxelMap& map, const Eigen::Vector2d& place_m, double lowest_m,
                        std::span<double> heights_m) noexcept {
  constexpr double kHighest_m = 30.0;
  constexpr double kRoom_m = 2.0;
  const double resolution_m = map.resolution_m();
  Eigen::Vector3d cells;
  cells << place_m, lowest_m;
  cells /= resolution_m;
  if (!has_cell(cells)) return 0;
  const Cell lowest = cell_of(cells);
  const auto room = static_cast<std::int32_t>(std::ceil(kRoom_m / resolution_m));
  const auto highest = lowest.k + static_cast<std::int32_t>(kHighest_m / resolution_m);
  std::size_t count = 0;
  std::int32_t free = room;
  // Downwards, so that the room over each is known.
  for (std::int32_t k = highest; k >= lowest.k; --k) {
    const Voxel* const voxel = voxel_of(map, {lowest.i, lowest.j, k});
    if (voxel != nullptr && free >= room) {
      // The lowest stay: each pushes the others up.
      std::shift_right(heights_m.begin(), heights_m.end(), 1);
      heights_m.front() = k * resolution_m + static_cast<double>(voxel->mean_m[2]);
      count = std::min(count + 1, heights_m.size());
    }
    free = voxel != nullptr ? 0 : free + 1;
  }
  return count;
}

std::optional<double> lowest_m(const VoxelMap& map, const Eigen::Vector2d& place_m,
                               double within_m) noexcept {
  const double half_block_m = 2.0 * map.resolution_m();
  std::optional<double> lowest_m;
  for (const BlockEntry& block : map.blocks()) {
    if (block.occupancy == 0) continue;
    const Cell corner = block_corner(block.key);
    const Eigen::Vector2d middle_m =
        map.resolution_m() * Eigen::Vector2d(corner.i, corner.j) + Eigen::Vector2d::Constant(half_block_m);
    if ((middle_m - place_m).cwiseAbs().maxCoeff() > within_m + half_block_m) continue;
    // Bits go up with the height, and so do the voxels of a block.
    const Cell in_block = cell_in_block(static_cast<unsigned>(std::countr_zero(block.occupancy)));
    const double height_m = (corner.k + in_block.k) * map.resolution_m() +
                            static_cast<double>(map.voxels()[block.first_voxel].mean_m[2]);
    if (!lowest_m || height_m < *lowest_m) lowest_m = height_m;
  }
  return lowest_m;
}

Pose on_slope(const VoxelMap& map, const Pose& pose) noexcept {
  constexpr double kArm_m = 4.0;
  constexpr double kWithin_m = 1.0;
  constexpr double kSteepest_rad = 0.15;
  const auto slope = [&](const Eigen::Vector3d& axis) -> std::optional<double> {
    const auto ahead_m = ground_m(map, pose.translation() + kArm_m * axis, kWithin_m);
    const auto behind_m = ground_m(map, pose.translation() - kArm_m * axis, kWithin_m);
    if (!ahead_m || !behind_m) return std::nullopt;
    const double angle_rad = std::atan2(*ahead_m - *behind_m, 2.0 * kArm_m);
    return std::abs(angle_rad) < kSteepest_rad ? std::optional(angle_rad)
                                               : std::nullopt;  // else a kerb or a car
  };
  const double yaw_rad = to_roll_pitch_yaw(pose.linear()).yaw_rad;
  const Eigen::Vector3d forward(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  const Eigen::Vector3d left(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  const auto up_rad = slope(forward);
  const auto left_up_rad = slope(left);
  return make_pose(
      pose.translation(),
      {.roll_rad = left_up_rad.value_or(0.0), .pitch_rad = -up_rad.value_or(0.0), .yaw_rad = yaw_rad});
}

Landmarks::Landmarks(std::span<const Eigen::Vector3f> points_m) noexcept {
  const auto tells = [](const Eigen::Vector3f& point_m) {
    return point_m.z() > static_cast<float>(kAboveGround_m);
  };
  const auto all = static_cast<std::size_t>(std::ranges::count_if(points_m, tells));
  const std::size_t stride = all / kMost + 1;  // evenly over the sweep
  std::size_t seen = 0;
  for (const Eigen::Vector3f& point_m : points_m) {
    if (tells(point_m) && seen++ % stride == 0 && count_ < kMost) points_m_[count_++] = point_m;
  }
}

std::size_t Landmarks::hits(const VoxelMap& map, const Pose& pose) const noexcept {
  const double per_m = 1.0 / map.resolution_m();
  const Eigen::Matrix3d turn = per_m * pose.linear();
  const Eigen::Vector3d shift = per_m * pose.translation();
  std::size_t hits = 0;
  for (const Eigen::Vector3f& point_m : std::span(points_m_).first(count_)) {
    const Eigen::Vector3d cells = turn * point_m.cast<double>() + shift;
    hits += has_cell(cells) && voxel_of(map, cell_of(cells)) != nullptr ? 1U : 0U;
  }
  return hits;
}

}  // namespace landfix::ndt
