// What the study finds out about one sensor on one route, as it is kept on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace landfix::tools::study {

/// One run of the study.
struct Case {
  std::string route;
  std::string sensor;
  double length_m = 0.0;  ///< 0: the whole route
  bool ablate = false;    ///< localize with one thing after the other set otherwise, too
  bool tune = false;      ///< look for the best settings, too, and write tuned.toml
  bool keep = false;      ///< captures and maps stay

  [[nodiscard]] std::string name() const {
    return std::filesystem::path(route).stem().string() + '-' + sensor;
  }
};

struct Spread {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard
};

/// What happened along the way; a value for each sweep.
struct Along {
  std::vector<double> way_m;  ///< truly travelled
  std::vector<double> elevation_m;
  std::vector<double> true_elevation_m;
  std::vector<double> position_error_m;
  std::vector<double> heading_error_deg;
  std::vector<double> iterations;
};

struct MappingFigures {
  std::size_t sweeps = 0;
  std::size_t added = 0;  ///< of them, to the map
  std::uint64_t points = 0;
  Spread iterations{};
  Spread fitness_score_m2{};
  double match_ms = 0.0;  ///< of CPU, a sweep
  double mean_map_entropy = 0.0;
  double mean_plane_variance_m = 0.0;
  double elevation_max_m = 0.0;  ///< largest error
  double position_rmse_m = 0.0;
  Along along{};
};

struct LocalizationFigures {
  std::size_t sweeps = 0;
  std::size_t tracking = 0;
  std::size_t lost = 0;
  std::size_t compared = 0;  ///< usable poses with a truth
  double points = 0.0;       ///< that are matched, a sweep
  Spread iterations{};
  double position_rmse_m = 0.0;
  double position_max_m = 0.0;
  double heading_rmse_deg = 0.0;
  double filter_ms = 0.0;  ///< median, by the clock: with what else the machine does
  double match_ms = 0.0;   ///< likewise
  double cpu_ms = 0.0;     ///< mean of CPU time, decoding and all
  Along along{};
};

/// A localization with something set otherwise.
struct Variation {
  std::string name{};
  double leaf_m = 2.0;
  double resolution_m = 1.0;
  double max_range_m = 200.0;
  std::string filter = "voxel";
  bool deskew = true;
  LocalizationFigures found{};
};

struct CaseFigures {
  std::size_t lasers = 0;
  std::uint64_t returns = 0;
  double length_m = 0.0;
  double duration_s = 0.0;
  double survey_entropy = 0.0;  ///< of the surveyed map
  double survey_plane_variance_m = 0.0;
  MappingFigures by_landfix{};  ///< landfix mapping
  MappingFigures by_study{};    ///< the same with --study-settings
  LocalizationFigures localization{};
  std::vector<Variation> variations{};
  bool has_pictures = false;
  double seconds = 0.0;  ///< that it took
  double disk_mb = 0.0;  ///< that it needed meanwhile
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Spread, mean, deviation)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Along, way_m, elevation_m, true_elevation_m, position_error_m,
                                   heading_error_deg, iterations)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MappingFigures, sweeps, added, points, iterations, fitness_score_m2,
                                   match_ms, mean_map_entropy, mean_plane_variance_m, elevation_max_m,
                                   position_rmse_m, along)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LocalizationFigures, sweeps, tracking, lost, compared, points, iterations,
                                   position_rmse_m, position_max_m, heading_rmse_deg, filter_ms, match_ms,
                                   cpu_ms, along)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Variation, name, leaf_m, resolution_m, max_range_m, filter, deskew, found)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CaseFigures, lasers, returns, length_m, duration_s, survey_entropy,
                                   survey_plane_variance_m, by_landfix, by_study, localization, variations,
                                   has_pictures, seconds, disk_mb)

}  // namespace landfix::tools::study
