// Stands in for pcl_rival.cpp where PCL is not installed.
#include "tools/command.hpp"
#include "tools/pcl_rival.hpp"

namespace landfix::tools {

struct PclRival::Parts {};

PclRival::PclRival(double /*resolution_m*/, double /*leaf_m*/) {
  throw UsageError(
      "--rival pcl: landfix was built without PCL; install libpcl-dev (apt-get install libpcl-dev), then "
      "configure and build again");
}

PclRival::~PclRival() = default;

bool PclRival::available() noexcept { return false; }

// No rival is ever made, so none of these is called.
std::string PclRival::name() { return "PCL"; }
void PclRival::set_map(std::span<const Eigen::Vector3d> /*points_m*/) {}
void PclRival::build_map() {}
void PclRival::set_scan(std::span<const Eigen::Vector3f> /*points_m*/) {}
// NOLINTNEXTLINE(readability-convert-member-functions-to-static): with PCL it is none
std::size_t PclRival::filter() { return 0; }
// NOLINTNEXTLINE(readability-convert-member-functions-to-static): with PCL it is none
Found PclRival::match(const ndt::Pose& guess) { return {.pose = guess}; }

}  // namespace landfix::tools
