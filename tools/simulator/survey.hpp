// A surveyor's point cloud of the standing world: sampled from its surfaces, not seen by the LiDAR.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "tools/simulator/ground.hpp"
#include "tools/simulator/mesh.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::simulator {

/// Standard deviation of a surveyed point.
inline constexpr double kSurveyNoise_m = 0.01;

/// Uniform by area, as dense and as far from the road as planned; nothing below the ground. Frame `map`.
/// The same arguments give the same points.
void survey(const Mesh& mesh, const Ground& ground, const SurveyPlan& plan, std::uint64_t seed,
            const std::function<void(const Eigen::Vector3f&)>& take);
[[nodiscard]] std::vector<Eigen::Vector3f> survey(const Mesh& mesh, const Ground& ground,
                                                  const SurveyPlan& plan, std::uint64_t seed);

}  // namespace landfix::tools::simulator
