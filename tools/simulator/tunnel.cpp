#include "tools/simulator/tunnel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace landfix::tools::simulator {
namespace {

constexpr double kWallFoot_m = 0.15;
constexpr double kNicheStep_m = 0.02;

class TunnelBuilder {
 public:
  TunnelBuilder(Mesh& mesh, const Ground& ground, const Tunnel& tunnel)
      : mesh_(mesh),
        ground_(ground),
        tunnel_(tunnel),
        half_width_m_(ground.road().half_width_m() + ground.road().pavement_width_m) {}

  void build() {
    const double first_m = ground_.path().first_station_m();
    const double last_m = ground_.path().last_station_m();
    add_stretch(first_m, last_m, vault());
    add_stretch(first_m, last_m, wall(half_width_m_));
    double free_from_m = first_m;
    for (const double middle_m : niches()) {
      add_stretch(free_from_m, middle_m - 0.5 * kNicheWidth_m, wall(-half_width_m_));
      free_from_m = middle_m + 0.5 * kNicheWidth_m;
      add_niche(middle_m - 0.5 * kNicheWidth_m, free_from_m);
    }
    add_stretch(free_from_m, last_m, wall(-half_width_m_));
  }

 private:
  /// Left of the middle of the road, and above the line that is driven.
  using Section = std::vector<Eigen::Vector2d>;

  [[nodiscard]] Section wall(double across_m) const {
    return {{across_m, -kWallFoot_m}, {across_m, tunnel_.wall_height_m}};
  }

  [[nodiscard]] Section vault() const {
    constexpr int kFacets = 36;
    Section section;
    for (int i = 0; i <= kFacets; ++i) {
      const double angle_rad = std::numbers::pi * i / kFacets;
      section.emplace_back(half_width_m_ * std::cos(angle_rad),
                           tunnel_.wall_height_m + half_width_m_ * std::sin(angle_rad));
    }
    return section;
  }

  [[nodiscard]] std::vector<double> niches() const {
    std::vector<double> middles_m;
    if (tunnel_.niche_spacing_m <= 0.0) return middles_m;
    const double first =
        std::ceil((ground_.path().first_station_m() + kNicheWidth_m) / tunnel_.niche_spacing_m);
    for (double i = first; i * tunnel_.niche_spacing_m < ground_.path().last_station_m() - kNicheWidth_m;
         ++i) {
      middles_m.push_back(i * tunnel_.niche_spacing_m);
    }
    return middles_m;
  }

  [[nodiscard]] Eigen::Vector3d point_m(double station_m, double across_m, double up_m) const {
    const PathPoint point = ground_.path().at(station_m);
    const Eigen::Vector2d xy_m =
        point.position_m.head<2>() + (ground_.road().centre_offset_m() + across_m) * point.left();
    return {xy_m.x(), xy_m.y(), point.position_m.z() + up_m};
  }

  void add_stretch(double from_m, double to_m, const Section& section) {
    constexpr double kRow_m = 2.0;
    const int steps = std::max(1, static_cast<int>(std::ceil((to_m - from_m) / kRow_m)));
    std::vector<std::vector<Eigen::Vector3d>> rows;
    for (int i = 0; i <= steps; ++i) {
      std::vector<Eigen::Vector3d>& row = rows.emplace_back();
      for (const Eigen::Vector2d& place : section) {
        row.push_back(point_m(from_m + (to_m - from_m) * i / steps, place.x(), place.y()));
      }
    }
    add_sheet(mesh_, rows, std::vector(section.size() - 1, Surface::concrete));
  }

  /// As high as the wall: floor, back and ceiling, then the two ends.
  void add_niche(double from_m, double to_m) {
    const double edge_m = -half_width_m_;
    const double back_m = edge_m - kNicheDepth_m;
    const double offset_m = ground_.road().centre_offset_m() + edge_m;
    // A little below the pavement, which is uneven: no light falls between them.
    const double floor_m = ground_.height_m(RoadPosition{from_m, offset_m}) -
                           ground_.path().at(from_m).position_m.z() - kNicheStep_m;
    const Section around{{edge_m, floor_m},
                         {back_m, floor_m},
                         {back_m, tunnel_.wall_height_m},
                         {edge_m, tunnel_.wall_height_m}};
    add_stretch(from_m, to_m, around);
    for (const double end_m : {from_m, to_m}) {
      std::array<Eigen::Vector3d, 4> corners;
      std::ranges::transform(around, corners.begin(), [&](const Eigen::Vector2d& place) {
        return point_m(end_m, place.x(), place.y());
      });
      add_quad(mesh_, Place::Identity(), corners, Surface::concrete);
    }
  }

  Mesh& mesh_;
  const Ground& ground_;
  const Tunnel& tunnel_;
  double half_width_m_;
};

}  // namespace

void add_tunnel(Mesh& mesh, const Ground& ground, const Tunnel& tunnel) {
  TunnelBuilder(mesh, ground, tunnel).build();
}

}  // namespace landfix::tools::simulator
