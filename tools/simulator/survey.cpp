#include "tools/simulator/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/simulator/random.hpp"

namespace landfix::tools::simulator {
namespace {

/// The side of the square that a point stands for.
double spacing_m(const SurveyPlan& plan, double distance_to_road_m) {
  constexpr double kNear_m = 10.0;
  return plan.spacing_m + plan.coarsening * std::max(0.0, distance_to_road_m - kNear_m);
}

}  // namespace

void survey(const Mesh& mesh, const Ground& ground, const SurveyPlan& plan, std::uint64_t seed,
            const std::function<void(const Eigen::Vector3f&)>& take) {
  constexpr double kBelowGround_m = 0.05;
  Random random(seed, RandomStream::survey);
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices_m[triangle[0]].cast<double>();
    const Eigen::Vector3d ab = mesh.vertices_m[triangle[1]].cast<double>() - a;
    const Eigen::Vector3d ac = mesh.vertices_m[triangle[2]].cast<double>() - a;
    const Eigen::Vector3d centre_m = a + (ab + ac) / 3.0;
    const double distance_m = ground.distance_to_drive_m(centre_m.head<2>(), plan.reach_m);
    if (distance_m > plan.reach_m) continue;
    const double area_m2 = 0.5 * ab.cross(ac).norm();
    const double expected = area_m2 / (spacing_m(plan, distance_m) * spacing_m(plan, distance_m));
    const auto count = static_cast<int>(expected + random.uniform(0.0, 1.0));
    for (int i = 0; i < count; ++i) {
      double u = random.uniform(0.0, 1.0);
      double v = random.uniform(0.0, 1.0);
      if (u + v > 1.0) {  // the other half of the parallelogram, folded over
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d point_m = a + u * ab + v * ac;
      if (point_m.z() < ground.height_m(Eigen::Vector2d(point_m.head<2>())) - kBelowGround_m) continue;
      const Eigen::Vector3d noise{random.normal(), random.normal(), random.normal()};
      take((point_m + kSurveyNoise_m * noise).cast<float>());
    }
  }
}

std::vector<Eigen::Vector3f> survey(const Mesh& mesh, const Ground& ground, const SurveyPlan& plan,
                                    std::uint64_t seed) {
  std::vector<Eigen::Vector3f> points_m;
  survey(mesh, ground, plan, seed, [&](const Eigen::Vector3f& point_m) { points_m.push_back(point_m); });
  return points_m;
}

}  // namespace landfix::tools::simulator
