#include "ndt/pair_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ndt/pair_lookup.hpp"

namespace landfix::ndt {
namespace {

/// No LiDAR sees farther; a point that did would take the digits of its group.
constexpr float kFarthest_m = 1e4F;

/// How far the pose has taken the group's points from where they were looked up, at most. A rotation by an
/// angle moves what is 1 m from its axis by 2 sin(angle / 2), which is the norm of the matrices' difference
/// over the root of 2.
[[nodiscard]] double moved_m(const PairGroup& group, const Pose& pose) noexcept {
  const Pose& before = group.looked_up_at;
  return (pose * group.centre_m - before * group.centre_m).norm() +
         std::numbers::sqrt2 / 2.0 * (pose.linear() - before.linear()).norm() * group.radius_m;
}

/// Some of a sequence: one from each of as many runs of equal length. Not always from the same place in its
/// run, as what is sorted has patterns that a constant stride would fall into step with.
class Thinning {
 public:
  Thinning(std::size_t size, std::size_t most) noexcept
      : count_(std::min(size, most)),
        run_(count_ != 0 ? static_cast<double>(size) / static_cast<double>(count_) : 1.0) {}

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t operator[](std::size_t n) const noexcept {
    const auto place = static_cast<std::uint32_t>(n * 0x9E3779B9U);  // multiples of the golden ratio (Weyl)
    return static_cast<std::size_t>((static_cast<double>(n) + 0x1p-32 * static_cast<double>(place)) * run_);
  }

 private:
  std::size_t count_;
  double run_;
};

}  // namespace

void PairGroups::assign(std::span<const Eigen::Vector3f> points_m, std::size_t most) noexcept {
  const Thinning thinning(points_m.size(), most);
  std::size_t size = 0;
  group_count_ = 0;
  dropped_pairs_ = 0;
  for (std::size_t next = 0; next < thinning.count() && size < points_m_.size();) {
    PairGroup& group = groups_[group_count_++];
    group = PairGroup{};
    group.first_point = size;
    for (; next < thinning.count() && size < points_m_.size() && group.point_count < points_per_group_;
         ++next) {
      const Eigen::Vector3f& point_m = points_m[thinning[next]];
      if (!(point_m.cwiseAbs().maxCoeff() < kFarthest_m)) continue;  // NaN is not
      points_m_[size++] = point_m;
      ++group.point_count;
      group.centre_m += point_m.cast<double>();
    }
    group.centre_m /= static_cast<double>(std::max<std::size_t>(group.point_count, 1));
    for (Eigen::Vector3f& point_m : std::span(points_m_).subspan(group.first_point, group.point_count)) {
      point_m = (point_m.cast<double>() - group.centre_m).cast<float>();
      group.radius_m = std::max(group.radius_m, static_cast<double>(point_m.norm()));
    }
  }
}

void PairGroups::update(const VoxelMap& map, const Pose& pose, Covariance covariance,
                        std::size_t group) noexcept {
  PairGroup& of = groups_[group];
  const bool is_near = of.is_looked_up && moved_m(of, pose) <= reach_.margin * map.resolution_m();
  if (is_near && of.covariance == covariance) return;
  of.covariance = covariance;
  if (!is_near) look_up(map, pose, group);
  fill_covariances(map, group);
}

void PairGroups::look_up(const VoxelMap& map, const Pose& pose, std::size_t index) noexcept {
  PairGroup& group = groups_[index];
  const double resolution_m = map.resolution_m();
  group.looked_up_at = pose;
  group.is_looked_up = true;
  group.pair_count = 0;
  const Eigen::Vector3d centre_m = pose * group.centre_m;
  const LatticePoint middle = to_lattice(centre_m, resolution_m, 1.0 / resolution_m);
  if (!middle.inside) return;  // a group beyond the lattice is beyond any map
  group.origin = middle.cell;
  const Eigen::Matrix3f rotation = pose.linear().cast<float>();
  const auto radius_m = static_cast<float>((reach_.pair + reach_.margin) * resolution_m);
  GroupPoints points{.count = group.point_count, .origin = group.origin, .radius_m = radius_m};
  for (std::size_t p = 0; p < group.point_count; ++p) {
    const Eigen::Vector3f& point_m = points_m_[group.first_point + p];
    const Eigen::Vector3f position_m = middle.offset_m + rotation * point_m;
    points.point_m[p] = {point_m.x(), point_m.y(), point_m.z()};
    points.position_m[p] = {position_m.x(), position_m.y(), position_m.z()};
  }
  const LookUp found = look_up_pairs(map, points, columns_[index]);
  group.pair_count = found.pairs;
  dropped_pairs_ += found.dropped;
}

void PairGroups::fill_covariances(const VoxelMap& map, std::size_t index) noexcept {
  const PairGroup& group = groups_[index];
  const auto inverse_covariance =
      group.covariance == Covariance::wide ? &Voxel::wide_1pm2 : &Voxel::sharp_1pm2;
  PairColumns& columns = columns_[index];
  for (std::size_t n = 0; n < group.pair_count; ++n) {
    const Symmetric3f& shape = map.voxels()[columns.voxel[n]].*inverse_covariance;
    for (std::size_t i = 0; i < shape.size(); ++i) columns.inverse_covariance_1pm2[i][n] = shape[i];
  }
}

}  // namespace landfix::ndt
