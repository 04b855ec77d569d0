// A replay as one page for a browser, which needs no other file and no network.
#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "platform/trajectory.hpp"
#include "tools/replay_report.hpp"

namespace landfix::tools {

struct HtmlReport {
  const ReplayReport& replay;
  std::span<const platform::StampedPose> truth;   ///< empty: not known
  std::span<const Eigen::Vector3f> map_points_m;  ///< frame `map`; empty: no map is drawn
  std::string sensor;
  std::string capture;
  std::string map;
  std::string command;  ///< that made it
  std::string version;
};

/// Well-formed as XML too; at most 2 MB and 100 bytes a sweep.
[[nodiscard]] std::string to_html(const HtmlReport& report);

}  // namespace landfix::tools
