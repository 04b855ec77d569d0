// The world as light meets it: triangles in Embree, and cars that move between them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include "tools/simulator/mesh.hpp"

namespace landfix::tools::simulator {

/// Frame `map`; `direction` is a unit vector.
struct Ray {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double reach_m = 0.0;
};

struct Hit {
  double range_m = 0.0;
  double cos_incidence = 0.0;  ///< 1: the ray is normal to the surface
  double reflectivity = 0.0;
};

/// A car at some instant.
struct MovingCar {
  Place place = Place::Identity();  ///< `map <- car`
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  std::size_t model = 0;
};

class Scene {
 public:
  /// `standing` does not move; `models` are what `MovingCar::model` counts. Throws std::runtime_error if
  /// Embree cannot start.
  Scene(std::span<const Mesh* const> standing, std::span<const Mesh> models);

  /// What the ray meets first. `later_s`: how long after the instant of `cars` the ray is sent. Thread-safe.
  [[nodiscard]] std::optional<Hit> cast(const Ray& ray, std::span<const MovingCar> cars,
                                        double later_s) const noexcept;

 private:
  struct Release {
    void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
  };
  using DeviceHandle = std::unique_ptr<RTCDeviceTy, Release>;
  using SceneHandle = std::unique_ptr<RTCSceneTy, Release>;

  struct Part {
    SceneHandle scene;
    std::vector<Surface> surfaces;
    double radius_m = 0.0;  ///< around the origin
  };

  [[nodiscard]] Part make_part(std::span<const Mesh* const> meshes) const;
  static void cast(const Part& part, const Ray& ray, std::optional<Hit>& nearest) noexcept;

  DeviceHandle device_;
  Part standing_;
  std::vector<Part> models_;
};

}  // namespace landfix::tools::simulator
