#include "tools/simulator/car_model.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace landfix::tools::simulator {
namespace {

/// The outline of a body at one place along its length.
struct Section {
  double x_m;
  double low_m;
  double waist_m;  ///< height where the sides begin to lean in
  double high_m;
  double half_low_m;   ///< half width up to the waist
  double half_high_m;  ///< half width at the top
};

constexpr std::array kHatchback{
    Section{-0.80, 0.35, 0.80, 0.95, 0.78, 0.70}, Section{-0.70, 0.25, 0.95, 1.10, 0.86, 0.72},
    Section{-0.35, 0.22, 0.95, 1.42, 0.88, 0.62}, Section{0.40, 0.20, 0.95, 1.48, 0.89, 0.62},
    Section{1.30, 0.20, 0.93, 1.46, 0.89, 0.61},  Section{2.15, 0.20, 0.92, 0.98, 0.89, 0.74},
    Section{3.00, 0.24, 0.80, 0.88, 0.86, 0.72},  Section{3.25, 0.35, 0.65, 0.72, 0.72, 0.62},
};
constexpr std::array kEstate{
    Section{-1.05, 0.35, 0.80, 0.95, 0.80, 0.72}, Section{-0.95, 0.25, 0.98, 1.20, 0.90, 0.72},
    Section{-0.70, 0.22, 0.98, 1.48, 0.91, 0.64}, Section{0.60, 0.20, 0.98, 1.52, 0.92, 0.64},
    Section{1.50, 0.20, 0.96, 1.50, 0.92, 0.63},  Section{2.45, 0.20, 0.95, 1.02, 0.92, 0.76},
    Section{3.40, 0.24, 0.82, 0.90, 0.89, 0.74},  Section{3.65, 0.35, 0.66, 0.74, 0.75, 0.64},
};
constexpr std::array kVan{
    Section{-1.10, 0.40, 1.20, 1.85, 0.94, 0.84}, Section{-1.00, 0.30, 1.20, 1.98, 0.96, 0.86},
    Section{0.80, 0.28, 1.20, 2.02, 0.97, 0.87},  Section{2.40, 0.28, 1.15, 1.96, 0.97, 0.84},
    Section{3.20, 0.28, 1.10, 1.20, 0.96, 0.84},  Section{3.95, 0.30, 0.90, 1.02, 0.93, 0.82},
    Section{4.15, 0.40, 0.70, 0.80, 0.84, 0.76},
};

void add_wheel(Mesh& mesh, double x_m, double y_m) {
  constexpr double kRadius_m = 0.32;
  constexpr double kWidth_m = 0.2;
  Place upright = Place::Identity();
  upright.translation() = Eigen::Vector3d(x_m, y_m + 0.5 * kWidth_m, kRadius_m);
  upright.linear() = Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  add_tube(mesh, upright, kRadius_m, kRadius_m, kWidth_m, Surface::metal);
}

Mesh make_car(std::span<const Section> sections, double wheelbase_m) {
  Mesh mesh;
  std::vector<std::vector<Eigen::Vector3d>> rings;
  for (const Section& s : sections) {
    rings.push_back({{s.x_m, s.half_low_m, s.low_m},
                     {s.x_m, s.half_low_m, s.waist_m},
                     {s.x_m, s.half_high_m, s.high_m},
                     {s.x_m, -s.half_high_m, s.high_m},
                     {s.x_m, -s.half_low_m, s.waist_m},
                     {s.x_m, -s.half_low_m, s.low_m},
                     {s.x_m, s.half_low_m, s.low_m}});
  }
  constexpr std::array kSkin{Surface::paint, Surface::glass, Surface::paint,
                             Surface::glass, Surface::paint, Surface::metal};
  add_sheet(mesh, rings, kSkin);
  for (const auto& end : {rings.front(), rings.back()}) {
    add_quad(mesh, Place::Identity(), {end[0], end[1], end[4], end[5]}, Surface::paint);
    add_quad(mesh, Place::Identity(), {end[1], end[2], end[3], end[4]}, Surface::paint);
  }
  for (const double x_m : {0.0, wheelbase_m}) {
    for (const double y_m : {-0.76, 0.76}) add_wheel(mesh, x_m, y_m);
  }
  return mesh;
}

}  // namespace

const std::array<Mesh, kCarModels>& car_models() {
  static const std::array<Mesh, kCarModels> models{make_car(kHatchback, 2.5), make_car(kEstate, 2.75),
                                                   make_car(kVan, 3.1)};
  return models;
}

void add_mesh(Mesh& mesh, const Place& place, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  const Eigen::Isometry3f place_f = place.cast<float>();
  for (const Eigen::Vector3f& vertex : part.vertices_m) mesh.vertices_m.push_back(place_f * vertex);
  for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  mesh.surfaces.insert(mesh.surfaces.end(), part.surfaces.begin(), part.surfaces.end());
}

}  // namespace landfix::tools::simulator
