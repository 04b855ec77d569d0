// Trajectories: poses with their times, and the TUM text format that carries them between programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ndt/pose.hpp"

namespace landfix::platform {

using ndt::StampedPose;

/// Lines `timestamp tx ty tz qx qy qz qw` [s, m], `#` begins a comment. Stamps are read as decimals, exact to
/// the nanosecond, and must increase; quaternions are normalised. Throws std::runtime_error with `name` and
/// the line.
[[nodiscard]] std::vector<StampedPose> parse_tum(std::string_view text, std::string_view name);
[[nodiscard]] std::vector<StampedPose> read_tum(const std::filesystem::path& path);

/// The same poses give the same bytes: stamps with 9 decimals, metres with 6, quaternions with 9 and w >= 0.
/// Stamps must not be negative.
[[nodiscard]] std::string format_tum(std::span<const StampedPose> poses);
void write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses);

/// Linear between the neighbours in translation, along the great circle in rotation; nothing outside of the
/// trajectory's time. Stamps of `poses` must increase.
[[nodiscard]] std::optional<ndt::Pose> interpolate(std::span<const StampedPose> poses,
                                                   std::int64_t stamp_utc_ns);

}  // namespace landfix::platform
