#include "tools/simulator/lidar_model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/simulator/hdl64_model.hpp"
#include "tools/simulator/ouster_model.hpp"
#include "tools/simulator/pandar_model.hpp"
#include "tools/simulator/robosense_model.hpp"
#include "tools/simulator/velodyne_model.hpp"
#include "tools/simulator/vls128_model.hpp"

namespace landfix::tools::simulator {
namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<LidarModel> (*make)();
};

constexpr std::array kModels{
    Entry{"vls128ap", [] { return make_vls128(Vls128Variant::alpha_prime); }},
    Entry{"vls128", [] { return make_vls128(Vls128Variant::vls128); }},
    Entry{"hdl64s2", [] { return make_hdl64(Hdl64Variant::s2); }},
    Entry{"hdl64s3", [] { return make_hdl64(Hdl64Variant::s3); }},
    Entry{"hdl64s1", [] { return make_hdl64(Hdl64Variant::s1); }},
    Entry{"hdl32e", [] { return make_velodyne(VelodyneSensor::hdl32e); }},
    Entry{"vlp32c", [] { return make_velodyne(VelodyneSensor::vlp32c); }},
    Entry{"vlp16", [] { return make_velodyne(VelodyneSensor::vlp16); }},
    Entry{"vlp16hires", [] { return make_velodyne(VelodyneSensor::vlp16hires); }},
    Entry{"pandar64", [] { return make_pandar(PandarVariant::pandar64); }},
    Entry{"pandar40p", [] { return make_pandar(PandarVariant::pandar40p); }},
    Entry{"os0-32", [] { return make_ouster("os0-32"); }},
    Entry{"os0-64", [] { return make_ouster("os0-64"); }},
    Entry{"os0-128", [] { return make_ouster("os0-128"); }},
    Entry{"os1-16", [] { return make_ouster("os1-16"); }},
    Entry{"os1-32", [] { return make_ouster("os1-32"); }},
    Entry{"os1-64", [] { return make_ouster("os1-64"); }},
    Entry{"os1-128", [] { return make_ouster("os1-128"); }},
    Entry{"os2-32", [] { return make_ouster("os2-32"); }},
    Entry{"os2-64", [] { return make_ouster("os2-64"); }},
    Entry{"os2-128", [] { return make_ouster("os2-128"); }},
    Entry{"rs32", [] { return make_robosense(RobosenseSensor::rs32); }},
    Entry{"rs16", [] { return make_robosense(RobosenseSensor::rs16); }},
    Entry{"helios16p", [] { return make_robosense(RobosenseSensor::helios16p); }},
};

}  // namespace

Eigen::Vector3d Shot::direction() const noexcept {
  const double elevation_rad = elevation_deg * std::numbers::pi / 180.0;
  const double azimuth_rad = azimuth_deg * std::numbers::pi / 180.0;
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), -std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

std::uint16_t rotor_angle_centideg(std::int64_t utc_ns) noexcept {
  return static_cast<std::uint16_t>(std::lround(100.0 * rotor_angle_deg(utc_ns)) % 36000);
}

std::vector<std::string_view> lidar_model_names() {
  std::vector<std::string_view> names;
  names.reserve(kModels.size());
  for (const Entry& entry : kModels) names.push_back(entry.name);
  return names;
}

std::unique_ptr<LidarModel> make_lidar_model(std::string_view name) {
  const auto* const found = std::ranges::find(kModels, name, &Entry::name);
  if (found == kModels.end()) {
    throw std::invalid_argument(fmt::format("the simulator has no sensor '{}'; there are {}", name,
                                            fmt::join(lidar_model_names(), ", ")));
  }
  return found->make();
}

}  // namespace landfix::tools::simulator
