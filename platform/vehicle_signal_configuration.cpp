#include "platform/vehicle_signal_configuration.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/dbc_file.hpp"

namespace landfix::platform {
namespace {

enum class Quantity : std::uint8_t { flag, speed, rate, angle, length };

struct Unit {
  Quantity quantity;
  std::string_view name;
  double si = 1.0;
};
/// Of each quantity the first is meant where none is named.
constexpr std::array kUnits{Unit{Quantity::speed, "m/s", 1.0},
                            Unit{Quantity::speed, "km/h", 1.0 / 3.6},
                            Unit{Quantity::speed, "mph", 0.44704},
                            Unit{Quantity::rate, "rad/s", 1.0},
                            Unit{Quantity::rate, "deg/s", std::numbers::pi / 180.0},
                            Unit{Quantity::angle, "deg", std::numbers::pi / 180.0},
                            Unit{Quantity::angle, "rad", 1.0},
                            Unit{Quantity::length, "m", 1.0}};

/// What is beyond `limit` either way is no value: 100 m/s and 3 rad/s no vehicle of the road reaches.
struct Kind {
  Quantity quantity = Quantity::flag;
  double limit = 1e9;
  double timeout_s = 1.0;
};

[[nodiscard]] Kind kind_of(VehicleRole role) {
  switch (role) {
    case VehicleRole::reverse:
      return {};
    case VehicleRole::yaw_rate:
      return {.quantity = Quantity::rate, .limit = 3.0, .timeout_s = 0.2};
    case VehicleRole::latitude:
      return {.quantity = Quantity::angle, .limit = std::numbers::pi / 2.0};
    case VehicleRole::longitude:
    case VehicleRole::heading:
      return {.quantity = Quantity::angle, .limit = 2.0 * std::numbers::pi};
    case VehicleRole::altitude:
      return {.quantity = Quantity::length, .limit = 10'000.0};
    default:
      return {.quantity = Quantity::speed, .limit = 100.0, .timeout_s = 0.2};
  }
}

/// DBC files write units in many ways.
[[nodiscard]] std::string normal_unit(std::string_view unit) {
  if (unit == "kph" || unit == "kmh" || unit == "KPH") return "km/h";
  if (unit == "MPH") return "mph";
  if (unit == "mps") return "m/s";
  if (unit == "deg/sec") return "deg/s";
  if (unit == "degree" || unit == "degrees" || unit == "Deg") return "deg";
  return std::string(unit);
}

[[nodiscard]] std::vector<std::string_view> units_of(Quantity quantity) {
  std::vector<std::string_view> names;
  for (const Unit& unit : kUnits) {
    if (unit.quantity == quantity) names.push_back(unit.name);
  }
  return names;
}

/// Null where the quantity has no such unit.
[[nodiscard]] const Unit* find_unit(Quantity quantity, std::string_view name) {
  const auto* const unit = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& each) {
    return each.quantity == quantity && each.name == name;
  });
  return unit == kUnits.end() ? nullptr : unit;
}

[[nodiscard]] std::string_view name_of(VehicleRole role) {
  return kVehicleRoleNames[static_cast<std::size_t>(role)];
}

[[nodiscard]] VehicleRole read_role(TomlSection& section, std::span<const VehicleRole> roles) {
  std::vector<std::string_view> names;
  std::transform(roles.begin(), roles.end(), std::back_inserter(names), name_of);
  section.require("role");
  std::string role;
  section.read(
      "role", role,
      [&names](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); },
      fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<VehicleRole>(std::find(kVehicleRoleNames.begin(), kVehicleRoleNames.end(), role) -
                                  kVehicleRoleNames.begin());
}

/// The signal that the DBC has under "MESSAGE.SIGNAL", its numbers still in its own unit.
void take_from_dbc(const TomlSection& section, const std::string& name,
                   const std::vector<DbcMessage>& messages, VehicleSignal& signal, std::string& unit) {
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
  section.fail("signal", "\"MESSAGE.SIGNAL\" of the file that dbc names");
}

void read_place(TomlSection& section, VehicleSignal& signal) {
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

/// From its own unit, `otherwise` where the section names none, to SI.
void read_unit(TomlSection& section, Quantity quantity, std::string otherwise, VehicleSignal& signal) {
  const auto fits = [quantity](std::string_view name) { return find_unit(quantity, name) != nullptr; };
  const std::string allowed = fmt::format("one of {}", fmt::join(units_of(quantity), ", "));
  std::string unit = otherwise;
  section.read("unit", unit, fits, allowed);
  if (!fits(unit)) section.fail("unit", fmt::format("{}; the DBC says \"{}\"", allowed, otherwise));
  signal.scale *= find_unit(quantity, unit)->si;
  signal.offset *= find_unit(quantity, unit)->si;
}

[[nodiscard]] VehicleSignal read_signal(TomlSection& section, std::span<const VehicleRole> roles,
                                        const std::vector<DbcMessage>& messages) {
  VehicleSignal signal;
  signal.role = read_role(section, roles);
  const Kind kind = kind_of(signal.role);

  std::string name;
  section.read(
      "signal", name, [](std::string_view text) { return !text.empty(); }, "\"MESSAGE.SIGNAL\"");
  std::string unit;
  if (kind.quantity != Quantity::flag) unit = units_of(kind.quantity).front();
  if (name.empty()) {
    read_place(section, signal);
  } else {
    take_from_dbc(section, name, messages, signal, unit);
  }
  if (kind.quantity != Quantity::flag) read_unit(section, kind.quantity, unit, signal);
  // In SI units.
  signal.high = kind.limit;
  section.read("max", signal.high, {0.0, 1e9});
  signal.low = -signal.high;
  section.read("min", signal.low, {-1e9, signal.high});
  signal.sign_bit = read_bit(section, "sign_bit");
  signal.valid_bit = read_bit(section, "valid_bit");
  section.read("valid_value", signal.valid_value);
  section.read("invalid_raw", signal.invalid_raw, signal.invalid_count);
  double timeout_s = kind.timeout_s;
  section.read("timeout_s", timeout_s, {0.01, 10.0});
  signal.timeout_ns = static_cast<std::int64_t>(timeout_s * 1e9);
  section.finish();
  return signal;
}

}  // namespace

void read_vehicle_signals(TomlSection& section, std::string_view name, std::span<const VehicleRole> roles,
                          VehicleSignals& signals) {
  std::filesystem::path dbc;
  section.read("dbc", dbc);
  const std::string full_name = fmt::format("{}.signal", name);
  std::vector<TomlSection> tables = section.tables("signal", full_name);
  section.finish();
  if (tables.size() > VehicleSignals::kMax)
    section.fail("signal", fmt::format("at most {} signals", VehicleSignals::kMax));
  const std::vector<DbcMessage> messages = dbc.empty() ? std::vector<DbcMessage>() : read_dbc(dbc);
  for (TomlSection& table : tables) {
    const VehicleSignal read = read_signal(table, roles, messages);
    if (signals.has(read.role)) table.fail("role", "each role at most once");
    signals.signals[signals.count] = read;
    ++signals.count;
  }
}

}  // namespace landfix::platform
