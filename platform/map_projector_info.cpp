#include "platform/map_projector_info.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "platform/atomic_file.hpp"
#include "platform/pose_frame_table.hpp"

namespace landfix::platform {
namespace {

using GeographicLib::UTMUPS;

// In the order of pose_frame_table::kProjectors and kDatums, which lead with what is unknown.
constexpr std::array<std::string_view, 5> kProjectorTypes{"Local", "MGRS", "LocalCartesianUTM",
                                                          "LocalCartesian", "TransverseMercator"};
constexpr std::array<std::string_view, 2> kVerticalDatums{"WGS84", "EGM2008"};
static_assert(kProjectorTypes.size() + 1 == pose_frame_table::kProjectors.size());
static_assert(kVerticalDatums.size() + 1 == pose_frame_table::kDatums.size());

constexpr double kUtmFalseEasting_m = 500e3;
constexpr double kUtmFalseNorthing_m = 10000e3;  // of the southern half

struct Origin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

/// The file, each of its values asked for by name.
class Info {
 public:
  Info(const YAML::Node& root, const std::filesystem::path& path) : root_(root), path_(path) {
    if (!root_.IsMap()) fail(root_, "expected projector_type and what belongs to it");
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& why) const {
    const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
    if (mark.is_null()) throw std::runtime_error(fmt::format("{}: {}", path_.string(), why));
    throw std::runtime_error(
        fmt::format("{}:{}:{}: {}", path_.string(), mark.line + 1, mark.column + 1, why));
  }

  /// Which of the names it is, from 1 on; 0: none is given.
  [[nodiscard]] std::uint16_t code(const char* key, std::span<const std::string_view> names) const {
    const YAML::Node node = root_[key];
    if (!node.IsDefined()) return 0;
    const auto* const name =
        node.IsScalar() ? std::find(names.data(), names.data() + names.size(), node.Scalar()) : nullptr;
    if (name == nullptr || name == names.data() + names.size())
      fail(node, fmt::format("{} is none of {}", key, fmt::join(names, ", ")));
    return static_cast<std::uint16_t>(name - names.data() + 1);
  }
  [[nodiscard]] YAML::Node get(const char* key) const { return root_[key]; }
  [[nodiscard]] double number(const YAML::Node& node, const char* key, double low, double high) const {
    const double value = node.IsScalar() ? node.as<double>(std::nan("")) : std::nan("");
    if (!(value >= low && value <= high))
      fail(node, fmt::format("{} is no number from {} to {}", key, low, high));
    return value;
  }
  [[nodiscard]] Origin origin() const {
    const YAML::Node node = root_["map_origin"];
    if (!node.IsDefined() || !node.IsMap()) fail(root_, "map_origin with latitude and longitude is missing");
    const auto required = [&](const char* key, double limit) {
      if (!node[key].IsDefined()) fail(node, fmt::format("map_origin has no {}", key));
      return number(node[key], key, -limit, limit);
    };
    Origin origin{.latitude_deg = required("latitude", 90.0), .longitude_deg = required("longitude", 180.0)};
    if (node["altitude"].IsDefined()) origin.altitude_m = number(node["altitude"], "altitude", -1e4, 1e5);
    return origin;
  }

 private:
  YAML::Node root_;
  const std::filesystem::path& path_;
};

[[nodiscard]] TransverseMercatorMap utm_map(int zone, bool is_north, const Eigen::Vector3d& zero_m) {
  const Eigen::Vector3d false_m(kUtmFalseEasting_m, is_north ? 0.0 : kUtmFalseNorthing_m, 0.0);
  return {.projection = GeographicLib::TransverseMercator::UTM(),
          .central_meridian_deg = 6.0 * zone - 183.0,
          .false_origin_m = zero_m - false_m};
}

/// The corner of a square of 100 km is the map's zero; z is the altitude.
void add_mgrs(const Info& info, MapReference& reference) {
  const YAML::Node node = info.get("mgrs_grid");
  if (!node.IsDefined() || !node.IsScalar()) info.fail(node, "mgrs_grid, such as 54SUE, is missing");
  int zone = 0;
  int precision = -1;
  bool is_north = true;
  double easting_m = 0.0;
  double northing_m = 0.0;
  try {
    GeographicLib::MGRS::Reverse(node.Scalar(), zone, is_north, easting_m, northing_m, precision, false);
  } catch (const GeographicLib::GeographicErr& error) {
    info.fail(node, fmt::format("mgrs_grid: {}", error.what()));
  }
  if (precision != 0 || zone < UTMUPS::MINUTMZONE)
    info.fail(node, "mgrs_grid is no square of 100 km between the polar regions, such as 54SUE");
  reference.utm_zone = static_cast<std::uint16_t>(zone);
  reference.projection = utm_map(zone, is_north, {easting_m, northing_m, 0.0});
}

void add_utm(const Info& info, MapReference& reference) {
  const Origin origin = info.origin();
  int zone = 0;
  bool is_north = true;
  double easting_m = 0.0;
  double northing_m = 0.0;
  UTMUPS::Forward(origin.latitude_deg, origin.longitude_deg, zone, is_north, easting_m, northing_m);
  if (zone < UTMUPS::MINUTMZONE)
    info.fail(info.get("map_origin"), "map_origin is in a polar region, which has no UTM");
  reference.utm_zone = static_cast<std::uint16_t>(zone);
  reference.projection = utm_map(zone, is_north, {easting_m, northing_m, origin.altitude_m});
}

void add_local_cartesian(const Info& info, MapReference& reference) {
  if (kVerticalDatums[reference.datum - 1U] != "WGS84")
    info.fail(info.get("vertical_datum"), "LocalCartesian needs heights above WGS84");
  const Origin origin = info.origin();
  reference.projection = LocalCartesianMap{
      GeographicLib::LocalCartesian(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)};
}

void add_transverse_mercator(const Info& info, MapReference& reference) {
  const Origin origin = info.origin();
  double scale = GeographicLib::Constants::UTM_k0();
  if (info.get("scale_factor").IsDefined())
    scale = info.number(info.get("scale_factor"), "scale_factor", 0.5, 2.0);
  const GeographicLib::TransverseMercator projection(GeographicLib::Constants::WGS84_a(),
                                                     GeographicLib::Constants::WGS84_f(), scale);
  double easting_m = 0.0;
  double northing_m = 0.0;
  projection.Forward(origin.longitude_deg, origin.latitude_deg, origin.longitude_deg, easting_m, northing_m);
  reference.projection = TransverseMercatorMap{.projection = projection,
                                               .central_meridian_deg = origin.longitude_deg,
                                               .false_origin_m = {easting_m, northing_m, origin.altitude_m}};
}

void add_local(const Info& /*info*/, MapReference& /*reference*/) {}

constexpr std::array kAdd{add_local, add_mgrs, add_utm, add_local_cartesian, add_transverse_mercator};
static_assert(kAdd.size() == kProjectorTypes.size());

[[nodiscard]] YAML::Node load(std::string_view text, const std::filesystem::path& path) {
  try {
    return YAML::Load(std::string(text));
  } catch (const YAML::ParserException& error) {
    throw std::runtime_error(
        fmt::format("{}:{}:{}: {}", path.string(), error.mark.line + 1, error.mark.column + 1, error.msg));
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

MapReference parse_map_projector_info(std::string_view text, const std::filesystem::path& path) {
  const Info info(load(text, path), path);
  MapReference reference;
  reference.projector = info.code("projector_type", kProjectorTypes);
  if (reference.projector == 0)
    info.fail(info.get("projector_type"),
              fmt::format("projector_type is missing: one of {}", fmt::join(kProjectorTypes, ", ")));
  reference.datum = info.code("vertical_datum", kVerticalDatums);
  if (reference.datum == 0 && kProjectorTypes[reference.projector - 1U] != "Local") reference.datum = 1;
  kAdd[reference.projector - 1U](info, reference);
  return reference;
}

MapReference read_map_projector_info(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return parse_map_projector_info({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace landfix::platform
