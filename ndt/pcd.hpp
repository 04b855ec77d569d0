// Reads PCD 0.7 point clouds: ascii, binary, binary_compressed; any fields, types and counts.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace landfix::ndt {

/// Calls `visit` with the values of `columns` (names of fields, their first element) for each point in order.
/// A column that the file lacks is NaN if it is not one of x, y, z. Throws std::runtime_error that begins
/// with `name` and says what is wrong, at which line or byte.
void visit_pcd(std::span<const std::byte> file, const std::string& name,
               std::span<const std::string_view> columns,
               const std::function<void(std::span<const double>)>& visit);

/// Calls `visit` with each point's position [m]. Points that are not finite are left out. Throws as above.
void visit_pcd_positions(std::span<const std::byte> file, const std::string& name,
                         const std::function<void(const Eigen::Vector3d&)>& visit);

}  // namespace landfix::ndt
