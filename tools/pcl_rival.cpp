// The only file that includes PCL's headers.
#include "tools/pcl_rival.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/ndt.h>

namespace landfix::tools {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

template <class Vector>
[[nodiscard]] Cloud::Ptr to_cloud(std::span<const Vector> points_m) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(points_m.size());
  for (const Vector& point_m : points_m) {
    cloud->emplace_back(static_cast<float>(point_m.x()), static_cast<float>(point_m.y()),
                        static_cast<float>(point_m.z()));
  }
  return cloud;
}

}  // namespace

struct PclRival::Parts {
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
  Cloud::Ptr map = pcl::make_shared<Cloud>();
  Cloud::Ptr filtered = pcl::make_shared<Cloud>();
  Cloud aligned;
};

PclRival::PclRival(double resolution_m, double leaf_m) : parts_(std::make_unique<Parts>()) {
  const auto leaf = static_cast<float>(leaf_m);
  parts_->filter.setLeafSize(leaf, leaf, leaf);
  parts_->ndt.setResolution(static_cast<float>(resolution_m));
  // Held against the square of a step's length: 1 cm. The usual 0.1 would stop at the first step.
  parts_->ndt.setTransformationEpsilon(1e-4);
  parts_->ndt.setStepSize(0.1);
  parts_->ndt.setMaximumIterations(50);
}

PclRival::~PclRival() = default;

bool PclRival::available() noexcept { return true; }
std::string PclRival::name() { return "PCL " PCL_VERSION_PRETTY; }

void PclRival::set_map(std::span<const Eigen::Vector3d> points_m) { parts_->map = to_cloud(points_m); }

void PclRival::build_map() { parts_->ndt.setInputTarget(parts_->map); }

void PclRival::set_scan(std::span<const Eigen::Vector3f> points_m) {
  parts_->filter.setInputCloud(to_cloud(points_m));
}

std::size_t PclRival::filter() {
  parts_->filter.filter(*parts_->filtered);
  return parts_->filtered->size();
}

Found PclRival::match(const ndt::Pose& guess) {
  parts_->ndt.setInputSource(parts_->filtered);
  parts_->ndt.align(parts_->aligned, guess.matrix().cast<float>());
  const Eigen::Matrix4d found = parts_->ndt.getFinalTransformation().cast<double>();
  Found result{.iterations = parts_->ndt.getFinalNumIteration()};
  result.pose.translation() = found.topRightCorner<3, 1>();
  // Single precision leaves it not quite a rotation.
  result.pose.linear() = Eigen::Quaterniond(found.topLeftCorner<3, 3>()).normalized().toRotationMatrix();
  return result;
}

}  // namespace landfix::tools
