#include "platform/configuration.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/atomic_file.hpp"
#include "support/error_of.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path kExample = std::filesystem::path(LANDFIX_CONFIG_FOLDER) / "landfix.toml";
const std::string kSensor = "[sensor]\nmodel = \"vlp16\"\n";

Configuration parse(const std::string& text) {
  return parse_configuration(text, "/etc/landfix/landfix.toml");
}

std::string error_of(const std::string& text) {
  return test::error_of([&] { return parse_configuration(text, "a.toml"); });
}

/// The error of one line below a section.
std::string error_of(const std::string& section, const std::string& line) {
  return section == "sensor" ? error_of(kSensor + line)
                             : error_of(fmt::format("{}[{}]\n{}", kSensor, section, line));
}

TEST(Configuration, TheExampleSaysTheDefaults) {
  const Configuration example = read_configuration(kExample);
  const Configuration defaults;
  EXPECT_EQ(example.sensor.model, "vlp16");  // these two have none
  EXPECT_EQ(example.map.file, std::filesystem::path(LANDFIX_CONFIG_FOLDER) / "map.ndt");

  EXPECT_EQ(example.map.memory_mib, defaults.map.memory_mib);
  EXPECT_EQ(example.sensor.calibration, defaults.sensor.calibration);
  EXPECT_EQ(example.sensor.address, defaults.sensor.address);
  EXPECT_EQ(example.sensor.port, defaults.sensor.port);
  EXPECT_EQ(example.sensor.multicast, defaults.sensor.multicast);
  EXPECT_EQ(example.sensor.interface, defaults.sensor.interface);
  EXPECT_EQ(example.sensor.receive_buffer_mib, defaults.sensor.receive_buffer_mib);
  EXPECT_EQ(example.sensor.cut_deg, defaults.sensor.cut_deg);
  EXPECT_EQ(example.sensor.min_range_m, defaults.sensor.min_range_m);
  EXPECT_EQ(example.sensor.max_range_m, defaults.sensor.max_range_m);
  EXPECT_EQ(example.vehicle.sensor_pose.matrix(), defaults.vehicle.sensor_pose.matrix());
  EXPECT_FALSE(example.initial_pose.pose);
  EXPECT_EQ(example.filter.kind, defaults.filter.kind);
  EXPECT_EQ(example.filter.leaf_m, defaults.filter.leaf_m);
  EXPECT_EQ(example.filter.entropy_share, defaults.filter.entropy_share);
  EXPECT_EQ(example.matcher.resolution_m, defaults.matcher.resolution_m);
  EXPECT_EQ(example.matcher.max_iterations, defaults.matcher.max_iterations);
  EXPECT_EQ(example.can.interface, defaults.can.interface);
  EXPECT_EQ(example.can.base_id, defaults.can.base_id);
  EXPECT_EQ(example.can.rate_hz, defaults.can.rate_hz);
  EXPECT_EQ(example.can.fd, defaults.can.fd);
  EXPECT_EQ(example.realtime.mode, defaults.realtime.mode);
  EXPECT_EQ(example.realtime.lock_memory, defaults.realtime.lock_memory);
  EXPECT_EQ(example.realtime.rx.priority, defaults.realtime.rx.priority);
  EXPECT_EQ(example.realtime.rx.core, defaults.realtime.rx.core);
  EXPECT_EQ(example.realtime.solve.priority, defaults.realtime.solve.priority);
  EXPECT_EQ(example.realtime.solve.core, defaults.realtime.solve.core);
  EXPECT_EQ(example.realtime.tx.priority, defaults.realtime.tx.priority);
  EXPECT_EQ(example.realtime.tx.core, defaults.realtime.tx.core);
  EXPECT_EQ(example.metrics.address, defaults.metrics.address);
  EXPECT_EQ(example.odometry.count, 0U);
  EXPECT_EQ(example.odometry.track_m, defaults.odometry.track_m);
  EXPECT_EQ(example.gnss.count, 0U);
  EXPECT_EQ(example.gnss.antenna_m, defaults.gnss.antenna_m);
  EXPECT_EQ(example.gnss.accuracy_m, defaults.gnss.accuracy_m);
}

TEST(Configuration, TheExampleMentionsEveryKey) {
  const auto bytes = read_file(kExample);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const char* section : {"sensor", "vehicle", "map", "initial_pose", "filter", "matcher", "can",
                              "realtime", "metrics", "odometry", "gnss"}) {
    // The message for an unknown key lists those that are known.
    const std::string error = error_of(section, "nonsense = 1");
    const std::string has = fmt::format("[{}] has ", section);
    ASSERT_THAT(error, HasSubstr(has));
    std::istringstream keys(error.substr(error.find(has) + has.size()));
    for (std::string key; std::getline(keys >> std::ws, key, ',');) {
      EXPECT_THAT(text, HasSubstr(fmt::format(
                            "\n{}{}", key == "pose" || key == "area" ? "# " : "",
                            key == "signal" ? fmt::format("# [[{}.signal]]", section) : key + " = ")))
          << section;
    }
  }
}

TEST(Configuration, EveryKeyIsRead) {
  const Configuration read = parse(R"(
[sensor]
model = "pandar64"
calibration = "unit.csv"
address = "192.168.1.201"
multicast = "239.255.0.1"
interface = "192.168.1.100"
receive_buffer_mib = 32.0
port = 2400
cut_deg = 180
min_range_m = 1.5
max_range_m = 100
[vehicle]
sensor_pose = [1.5, 0, 1.8, 0.0, 2.0, 90.0]
[map]
file = "/maps/town.ndt"
memory_mib = 512.5
[initial_pose]
pose = [10, 20, 0, 0, 0, -90]
[filter]
kind = "ring"
leaf_m = 1.0
entropy_share = 0.25
[matcher]
resolution_m = 2.0
max_iterations = 30
[can]
interface = "vcan1"
base_id = 0x500
rate_hz = 50
fd = true
[realtime]
mode = "required"
lock_memory = false
rx_priority = 90
rx_core = 3
solve_priority = 60
solve_core = 2
tx_priority = 65
tx_core = 1
[metrics]
address = "unix:/run/landfix/metrics"
)");
  EXPECT_EQ(read.sensor.model, "pandar64");
  EXPECT_EQ(read.sensor.calibration, "/etc/landfix/unit.csv");
  EXPECT_EQ(read.sensor.address, "192.168.1.201");
  EXPECT_EQ(read.sensor.multicast, "239.255.0.1");
  EXPECT_EQ(read.sensor.interface, "192.168.1.100");
  EXPECT_EQ(read.sensor.receive_buffer_mib, 32.0);
  EXPECT_EQ(read.sensor.port, 2400);
  EXPECT_EQ(read.sensor.cut_deg, 180.0);
  EXPECT_EQ(read.sensor.min_range_m, 1.5);
  EXPECT_EQ(read.sensor.max_range_m, 100.0);
  EXPECT_EQ(read.vehicle.sensor_pose.translation(), Eigen::Vector3d(1.5, 0, 1.8));
  const ndt::RollPitchYaw angles = ndt::to_roll_pitch_yaw(read.vehicle.sensor_pose.linear());
  EXPECT_NEAR(angles.pitch_rad, 2.0 * M_PI / 180.0, 1e-12);
  EXPECT_NEAR(angles.yaw_rad, M_PI / 2, 1e-12);
  EXPECT_EQ(read.map.file, "/maps/town.ndt");
  EXPECT_EQ(read.map.memory_mib, 512.5);
  EXPECT_EQ(read.initial_pose.pose->translation(), Eigen::Vector3d(10, 20, 0));
  EXPECT_EQ(read.filter.kind, ndt::FilterKind::ring);
  EXPECT_EQ(read.filter.leaf_m, 1.0);
  EXPECT_EQ(read.filter.entropy_share, 0.25);
  EXPECT_EQ(read.matcher.resolution_m, 2.0);
  EXPECT_EQ(read.matcher.max_iterations, 30);
  EXPECT_EQ(read.can.interface, "vcan1");
  EXPECT_EQ(read.can.base_id, 0x500U);
  EXPECT_EQ(read.can.rate_hz, 50.0);
  EXPECT_TRUE(read.can.fd);
  EXPECT_EQ(read.realtime.mode, RealtimeMode::required);
  EXPECT_FALSE(read.realtime.lock_memory);
  EXPECT_EQ(read.realtime.rx.priority, 90);
  EXPECT_EQ(read.realtime.rx.core, 3);
  EXPECT_EQ(read.realtime.solve.priority, 60);
  EXPECT_EQ(read.realtime.solve.core, 2);
  EXPECT_EQ(read.realtime.tx.priority, 65);
  EXPECT_EQ(read.realtime.tx.core, 1);
  EXPECT_EQ(read.metrics.address, "unix:/run/landfix/metrics");
}

TEST(Configuration, ErrorsSayWhereAndWhatIsAllowed) {
  EXPECT_EQ(error_of("filter", "leaf_m = -1"),
            "a.toml:4:10: filter.leaf_m = -1; expected a number from 0.05 to 20");
  EXPECT_EQ(error_of("filter", "leaf = 1"),
            "a.toml:4:1: unknown key leaf; [filter] has kind, leaf_m, entropy_share");
  EXPECT_THAT(error_of(kSensor + "[filtre]"),
              StartsWith("a.toml:3:2: unknown section or key filtre; there are"));
  EXPECT_THAT(error_of("[sensor]\nmodel = \"vlp61\""),
              StartsWith("a.toml:2:9: sensor.model = 'vlp61'; expected one of "));
  EXPECT_EQ(error_of("[filter]\nleaf_m = 2"), "a.toml: model is missing; add it to the section [sensor]");
  EXPECT_THAT(error_of(kSensor + "oops"), StartsWith("a.toml:3:"));
  EXPECT_THAT(error_of("sensor", "min_range_m = 300"), HasSubstr("more than min_range_m"));
  EXPECT_THAT(error_of("sensor = 1"), StartsWith("a.toml:1:10: sensor is a section"));
}

TEST(Configuration, BadValuesAreRefused) {
  const std::vector<std::pair<const char*, const char*>> lines{
      {"sensor", "port = 65536"},
      {"sensor", "port = 1.5"},
      {"sensor", "address = \"1.2.3\""},
      {"sensor", "address = \"1.2.3.4 \""},
      {"sensor", "multicast = \"192.168.1.201\""},
      {"sensor", "interface = \"eth0\""},
      {"sensor", "receive_buffer_mib = 0.1"},
      {"sensor", "cut_deg = 360"},
      {"sensor", "cut_deg = nan"},
      {"sensor", "max_range_m = inf"},
      {"sensor", "calibration = 1"},
      {"filter", "leaf_m = \"2\""},
      {"filter", "leaf_m = nan"},
      {"filter", "leaf_m = true"},
      {"filter", "leaf_m = 0"},
      {"filter", "kind = \"median\""},
      {"filter", "kind = 1"},
      {"filter", "entropy_share = 0"},
      {"matcher", "max_iterations = 0"},
      {"matcher", "max_iterations = 50.0"},
      {"matcher", "resolution_m = 0.0"},
      {"can", "base_id = 0x7F7"},
      {"can", "base_id = -1"},
      {"can", "interface = \"can 0\""},
      {"can", "rate_hz = 0"},
      {"can", "fd = 0"},
      {"realtime", "mode = \"on\""},
      {"realtime", "mode = true"},
      {"realtime", "rx_priority = 99"},
      {"realtime", "solve_priority = 0"},
      {"realtime", "tx_core = -2"},
      {"realtime", "lock_memory = 1"},
      {"metrics", "address = \"localhost\""},
      {"metrics", "address = \"127.0.0.1:0\""},
      {"metrics", "address = \"127.0.0.1:99999\""},
      {"metrics", "address = \"unix:metrics\""},
      {"vehicle", "sensor_pose = [0, 0, 0, 0, 0]"},
      {"vehicle", "sensor_pose = [0, 0, 0, 0, 0, \"0\"]"},
      {"vehicle", "sensor_pose = [0, 0, 0, 0, 0, nan]"},
      {"vehicle", "sensor_pose = 0"},
      {"initial_pose", "pose = [1e9, 0, 0, 0, 0, 0]"},
      {"initial_pose", "pose = [0, 0, 0, 0, 0, 361]"},
      {"initial_pose", "area = [0, 0]"},
      {"initial_pose", "area = [0, 0, 0]"},
      {"initial_pose", "area = [0, 0, -1]"},
      {"initial_pose", "area = [0, \"here\", 1]"},
      {"initial_pose", "pose = [0, 0, 0, 0, 0, 0]\narea = [0, 0, 1]"},
  };
  for (const auto& [section, line] : lines) {
    EXPECT_THAT(error_of(section, line), HasSubstr("expected ")) << section << ' ' << line;
  }
}

TEST(Configuration, AnAreaToBeLookedForIn) {
  const Configuration read = parse(kSensor + "[initial_pose]\narea = [100.5, -20, 50]\n");
  EXPECT_FALSE(read.initial_pose.pose);
  EXPECT_EQ(read.initial_pose.area->position_m, Eigen::Vector2d(100.5, -20.0));
  EXPECT_EQ(read.initial_pose.area->within_m, 50.0);
  EXPECT_FALSE(read.initial_pose.area->yaw_rad);
}

TEST(Configuration, PathsStartFromTheFilesFolder) {
  const test::TemporaryDirectory directory;
  std::ofstream(directory.path() / "c.toml") << kSensor + "[map]\nfile = \"maps/a.ndt\"\n";
  EXPECT_EQ(read_configuration(directory.path() / "c.toml").map.file, directory.path() / "maps/a.ndt");
  EXPECT_TRUE(parse(kSensor).map.file.empty());
  EXPECT_THROW((void)read_configuration(directory.path() / "absent.toml"), std::runtime_error);
}

}  // namespace
}  // namespace landfix::platform
