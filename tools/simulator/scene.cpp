#include "tools/simulator/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace landfix::tools::simulator {
namespace {

/// All meshes as one: triangles in order, so that a hit's number finds its surface.
Mesh merged(std::span<const Mesh* const> meshes) {
  Mesh all;
  for (const Mesh* mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(all.vertices_m.size());
    all.vertices_m.insert(all.vertices_m.end(), mesh->vertices_m.begin(), mesh->vertices_m.end());
    for (const auto& [a, b, c] : mesh->triangles) all.triangles.push_back({first + a, first + b, first + c});
    all.surfaces.insert(all.surfaces.end(), mesh->surfaces.begin(), mesh->surfaces.end());
  }
  return all;
}

template <class T>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
  void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
  if (buffer == nullptr && !values.empty()) throw std::runtime_error("Embree: out of memory for the scene");
  std::copy(values.begin(), values.end(), static_cast<T*>(buffer));
}

}  // namespace

// One thread: the same tree, and with it the same bytes, on every run.
Scene::Scene(std::span<const Mesh* const> standing, std::span<const Mesh> models)
    : device_(rtcNewDevice("threads=1")) {
  if (!device_) {
    throw std::runtime_error(
        fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  standing_ = make_part(standing);
  for (const Mesh& model : models) {
    const Mesh* const one = &model;
    models_.push_back(make_part(std::span(&one, 1)));
  }
}

Scene::Part Scene::make_part(std::span<const Mesh* const> meshes) const {
  Mesh mesh = merged(meshes);
  Part part;
  part.scene.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(part.scene.get(), RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices_m);
  fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(part.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(part.scene.get());
  part.surfaces = std::move(mesh.surfaces);
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    part.radius_m = std::max(part.radius_m, static_cast<double>(vertex.norm()));
  }
  return part;
}

void Scene::cast(const Part& part, const Ray& ray, std::optional<Hit>& nearest) noexcept {
  const Eigen::Vector3f origin_m = ray.origin_m.cast<float>();
  const Eigen::Vector3f direction = ray.direction.cast<float>();
  RTCRayHit query{};
  query.ray.org_x = origin_m.x();
  query.ray.org_y = origin_m.y();
  query.ray.org_z = origin_m.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tfar = static_cast<float>(nearest ? nearest->range_m : ray.reach_m);
  query.ray.mask = std::numeric_limits<unsigned>::max();
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(part.scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  const Eigen::Vector3d normal(static_cast<double>(query.hit.Ng_x), static_cast<double>(query.hit.Ng_y),
                               static_cast<double>(query.hit.Ng_z));
  nearest = Hit{.range_m = static_cast<double>(query.ray.tfar),
                .cos_incidence = std::abs(normal.normalized().dot(ray.direction)),
                .reflectivity = reflectivity(part.surfaces[query.hit.primID])};
}

std::optional<Hit> Scene::cast(const Ray& ray, std::span<const MovingCar> cars,
                               double later_s) const noexcept {
  std::optional<Hit> nearest;
  cast(standing_, ray, nearest);
  for (const MovingCar& car : cars) {
    const Part& model = models_[car.model];
    // The car has moved on: in its own frame the ray's origin has stayed behind.
    const Eigen::Vector3d origin_m = ray.origin_m - later_s * car.velocity_mps;
    const Eigen::Vector3d to_car_m = car.place.translation() - origin_m;
    const double along_m = to_car_m.dot(ray.direction);
    const bool misses = along_m < -model.radius_m ||
                        to_car_m.squaredNorm() - along_m * along_m > model.radius_m * model.radius_m;
    if (misses) continue;
    const Eigen::Matrix3d to_car = car.place.linear().transpose();
    cast(model, {to_car * -to_car_m, to_car * ray.direction, ray.reach_m}, nearest);
  }
  return nearest;
}

}  // namespace landfix::tools::simulator
