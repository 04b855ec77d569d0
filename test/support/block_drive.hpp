// Once around a small block, 140 m, simulated with its map: quick to make, with straights and corners.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/run_landfix.hpp"
#include "support/test_data.hpp"

namespace landfix::test {

/// A folder with capture.pcap, truth.tum, map.ndt and config.toml.
class BlockDrive {
 public:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (directory_.path() / name).string();
  }

  /// To be called once, under ASSERT_NO_FATAL_FAILURE.
  void simulate() {
    write_route();
    const Outcome simulated =
        run_landfix({"simulate", "--route", path("block.toml"), "--sensor", "vlp16", "--output", path("")});
    ASSERT_EQ(simulated.code, 0) << simulated.error;
    const Outcome mapped =
        run_landfix({"map", "--pcd", path("map.pcd"), "--resolution", "1", "--output", path("map.ndt")});
    ASSERT_EQ(mapped.code, 0) << mapped.error;
  }

 private:
  void write_route() const {
    std::ofstream route(path("block.toml"));
    route << R"(seed = 5
heading_deg = 0.0
[road]
lanes = 2
lane_width_m = 3.0
parking_width_m = 0.0
pavement_width_m = 2.0
[scenery]
buildings_per_100m = 6.0
building_setback_m = 4.0
building_height_m = 10.0
trees_per_100m = 8.0
poles_per_100m = 6.0
signs_per_100m = 2.0
boundaries_per_100m = 2.0
side_streets_per_100m = 0.0
parked_cars_per_100m = 0.0
moving_cars_per_100m = 0.0
)";
    for (const double straight_m : {5.0, 10.0, 10.0, 10.0}) {
      route << "[[segment]]\nlength_m = " << straight_m << "\ngrade = 0.0\nspeed_kmh = 25.0\n"
            << "[[segment]]\nlength_m = 25.0\nturn_deg = 90.0\ngrade = 0.0\nspeed_kmh = 20.0\n";
    }
    route << "[[segment]]\nlength_m = 5.0\ngrade = 0.0\nspeed_kmh = 25.0\n";
  }

  TemporaryDirectory directory_;
};

}  // namespace landfix::test
