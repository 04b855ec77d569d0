#include "platform/odometry_configuration.hpp"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/dbc_file.hpp"

namespace landfix::platform {
namespace {

struct Unit {
  std::string_view name;
  double si = 1.0;
  bool is_speed = false;
};
constexpr std::array kUnits{Unit{"m/s", 1.0, true}, Unit{"km/h", 1.0 / 3.6, true}, Unit{"mph", 0.44704, true},
                            Unit{"rad/s", 1.0, false}, Unit{"deg/s", std::numbers::pi / 180.0, false}};

/// DBC files write units in many ways.
[[nodiscard]] std::string normal_unit(std::string_view unit) {
  if (unit == "kph" || unit == "kmh" || unit == "KPH") return "km/h";
  if (unit == "MPH") return "mph";
  if (unit == "mps") return "m/s";
  if (unit == "deg/sec") return "deg/s";
  return std::string(unit);
}

[[nodiscard]] const Unit* find_unit(std::string_view name) {
  const auto* const unit =
      std::find_if(kUnits.begin(), kUnits.end(), [name](const Unit& each) { return each.name == name; });
  return unit == kUnits.end() ? nullptr : unit;
}

[[nodiscard]] bool is_role(std::string_view name) {
  return std::find(kOdometryRoleNames.begin(), kOdometryRoleNames.end(), name) != kOdometryRoleNames.end();
}

/// The signal that the DBC has under "MESSAGE.SIGNAL", its numbers still in its own unit.
void take_from_dbc(const TomlSection& section, const std::string& name,
                   const std::vector<DbcMessage>& messages, OdometrySignal& signal, std::string& unit) {
  for (const DbcMessage& message : messages) {
    for (const DbcSignal& known : message.signals) {
      if (fmt::format("{}.{}", message.name, known.name) != name) continue;
      if (known.multiplexed) section.fail("signal", "one that is not multiplexed");
      signal.id = message.id;
      signal.extended = message.extended;
      signal.field = known.field;
      signal.scale = known.scale;
      signal.offset = known.offset;
      unit = normal_unit(known.unit);
      return;
    }
  }
  section.fail("signal", "\"MESSAGE.SIGNAL\" of the file that [odometry] dbc names");
}

void read_place(TomlSection& section, OdometrySignal& signal) {
  for (const char* const key : {"id", "start", "length"}) section.require(key);
  section.read("extended", signal.extended);
  section.read<std::uint32_t>("id", signal.id, {0, signal.extended ? 0x1FFFFFFFU : 0x7FFU});
  section.read<std::uint16_t>("start", signal.field.start, {0, 511});
  section.read<std::uint8_t>("length", signal.field.length, {1, 64});
  std::string order = "intel";
  section.read(
      "order", order, [](std::string_view name) { return name == "intel" || name == "motorola"; },
      R"("intel" or "motorola")");
  signal.field.motorola = order == "motorola";
  section.read("signed", signal.field.is_signed);
  if (bytes_of(signal.field) > kMaxFdBytes) section.fail("length", "bits within a frame's 64 bytes");
  section.read("scale", signal.scale, {-1e6, 1e6});
  section.read("offset", signal.offset, {-1e6, 1e6});
  if (signal.scale == 0.0) section.fail("scale", "not 0");
}

/// -1: none.
[[nodiscard]] std::optional<std::uint16_t> read_bit(TomlSection& section, std::string_view key) {
  std::int32_t bit = -1;
  section.read<std::int32_t>(key, bit, {-1, 511});
  return bit < 0 ? std::nullopt : std::optional(static_cast<std::uint16_t>(bit));
}

[[nodiscard]] OdometrySignal read_signal(TomlSection& section, const std::vector<DbcMessage>& messages) {
  OdometrySignal signal;
  section.require("role");
  std::string role;
  section.read("role", role, is_role, fmt::format("one of {}", fmt::join(kOdometryRoleNames, ", ")));
  signal.role = static_cast<OdometryRole>(
      std::find(kOdometryRoleNames.begin(), kOdometryRoleNames.end(), role) - kOdometryRoleNames.begin());
  const bool is_reverse = signal.role == OdometryRole::reverse;
  const bool is_speed = !is_reverse && signal.role != OdometryRole::yaw_rate;

  std::string name;
  section.read(
      "signal", name, [](std::string_view text) { return !text.empty(); }, "\"MESSAGE.SIGNAL\"");
  std::string unit = is_speed ? "m/s" : "rad/s";
  if (name.empty()) {
    read_place(section, signal);
  } else {
    take_from_dbc(section, name, messages, signal, unit);
  }
  const auto fits = [is_speed](std::string_view text) {
    const Unit* const known = find_unit(text);
    return known != nullptr && known->is_speed == is_speed;
  };
  const std::string allowed = is_speed ? "one of m/s, km/h, mph" : "one of rad/s, deg/s";
  if (!is_reverse) {
    section.read("unit", unit, fits, allowed);
    if (!fits(unit)) section.fail("unit", fmt::format("{}; the DBC says \"{}\"", allowed, unit));
    signal.scale *= find_unit(unit)->si;
    signal.offset *= find_unit(unit)->si;
  }
  // In SI units; 100 m/s and 3 rad/s are beyond any vehicle on a road.
  signal.high = is_reverse ? 1e9 : is_speed ? 100.0 : 3.0;
  section.read("max", signal.high, {0.0, 1e9});
  signal.low = -signal.high;
  section.read("min", signal.low, {-1e9, signal.high});
  signal.sign_bit = read_bit(section, "sign_bit");
  signal.valid_bit = read_bit(section, "valid_bit");
  section.read("valid_value", signal.valid_value);
  section.read("invalid_raw", signal.invalid_raw, signal.invalid_count);
  double timeout_s = is_reverse ? 1.0 : 0.2;
  section.read("timeout_s", timeout_s, {0.01, 10.0});
  signal.timeout_ns = static_cast<std::int64_t>(timeout_s * 1e9);
  section.finish();
  return signal;
}

}  // namespace

void read_odometry(TomlSection section, OdometrySettings& odometry) {
  std::filesystem::path dbc;
  section.read("dbc", dbc);
  section.read("track_m", odometry.track_m, {0.0, 5.0});
  std::vector<TomlSection> signals = section.tables("signal", "odometry.signal");
  section.finish();
  if (signals.size() > OdometrySettings::kMaxSignals)
    section.fail("signal", fmt::format("at most {} signals", OdometrySettings::kMaxSignals));
  const std::vector<DbcMessage> messages = dbc.empty() ? std::vector<DbcMessage>() : read_dbc(dbc);
  for (TomlSection& signal : signals) {
    const OdometrySignal read = read_signal(signal, messages);
    if (odometry.has(read.role)) signal.fail("role", "each role at most once");
    odometry.signals[odometry.count] = read;
    ++odometry.count;
  }
}

}  // namespace landfix::platform
