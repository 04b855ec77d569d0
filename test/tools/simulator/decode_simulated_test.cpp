// The whole way there and back: what the simulator writes, a decoder of its own making reads, and the points
// lie where the survey says that the world is.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/make_decoder.hpp"
#include "support/test_route.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/simulator/survey.hpp"

namespace landfix::tools::simulator {
namespace {

/// Distance to the nearest of many points, up to one cell.
class NearestPoint {
 public:
  explicit NearestPoint(const std::vector<Eigen::Vector3f>& points_m) {
    for (const Eigen::Vector3f& point_m : points_m) cells_[key(cell_of(point_m))].push_back(point_m);
  }

  [[nodiscard]] float distance_m(const Eigen::Vector3f& point_m) const {
    float nearest_m = kCell_m;
    const Eigen::Vector3i centre = cell_of(point_m);
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const auto cell = cells_.find(key(centre + Eigen::Vector3i(x, y, z)));
          if (cell == cells_.end()) continue;
          for (const Eigen::Vector3f& other_m : cell->second) {
            nearest_m = std::min(nearest_m, (other_m - point_m).norm());
          }
        }
      }
    }
    return nearest_m;
  }

 private:
  static constexpr float kCell_m = 0.5F;

  static Eigen::Vector3i cell_of(const Eigen::Vector3f& point_m) {
    return (point_m / kCell_m).array().floor().cast<int>();
  }
  static std::int64_t key(const Eigen::Vector3i& cell) {
    return (std::int64_t{cell.x()} << 40) + (std::int64_t{cell.y()} << 20) + std::int64_t{cell.z()};
  }

  std::unordered_map<std::int64_t, std::vector<Eigen::Vector3f>> cells_;
};

TEST(DecodeSimulated, PointsMovedByTheTruthLieOnTheSurveyedMap) {
  Route route = test::route_of(test::kStreetRoute);
  route.scenery.parked_cars = 0.0;  // the survey knows of no cars
  route.scenery.moving_cars = 0.0;
  const Drive drive(route, 5);
  const NearestPoint map(survey(drive.world().surveyed, drive.ground(), drive.route().survey, drive.seed()));
  const drivers::SensorModel* const model = drivers::find_sensor_model("vlp16");
  ASSERT_NE(model, nullptr);
  drivers::AnyDecoder decoder = drivers::make_decoder(*model, {});
  std::vector<drivers::Point> storage(2 * model->max_points_per_sweep());
  drivers::SweepPair sweeps(storage);
  const ndt::Pose mounting = kSensorMounting.pose();

  std::size_t sweeps_seen = 0;
  std::vector<float> distances_m;
  for (std::size_t packet = 0; packet < drive.packets(); ++packet) {
    const auto payload = drive.lidar().encode(packet, drive.packet_utc_ns(packet), drive.fire(packet));
    const std::int64_t receive_utc_ns = drive.packet_utc_ns(packet + 1);
    const drivers::DecodeResult result = decoder.decode({payload, receive_utc_ns}, sweeps);
    ASSERT_EQ(result.status, drivers::DecodeStatus::decoded) << to_string(result.status);
    if (!result.sweep_completed) continue;
    const drivers::Sweep& sweep = sweeps.completed();
    ASSERT_EQ(sweep.complete(), sweeps_seen++ > 0);  // the capture begins in the middle of a turn
    const double start_s = 1e-9 * static_cast<double>(sweep.start_utc_ns() - kDriveStart_utc_ns);
    for (std::size_t i = 0; i < sweep.points().size(); i += 101) {
      const drivers::Point& point = sweep.points()[i];
      const ndt::Pose sensor =
          drive.vehicle().pose_at(start_s + static_cast<double>(point.time_s)) * mounting;
      const Eigen::Vector3d point_m = sensor * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
      distances_m.push_back(map.distance_m(point_m.cast<float>()));
    }
  }
  EXPECT_GT(sweeps_seen, 80U);
  ASSERT_GT(distances_m.size(), 10'000U);
  std::ranges::sort(distances_m);
  // Surveyed points are 0.1 m apart near the road and up to 0.7 m at the survey's end.
  EXPECT_LT(distances_m[distances_m.size() / 2], 0.06F);
  EXPECT_LT(distances_m[distances_m.size() * 9 / 10], 0.2F);
}

}  // namespace
}  // namespace landfix::tools::simulator
