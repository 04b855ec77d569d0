// How far an estimated trajectory is from a reference: absolute and relative errors, as the field defines
// them (Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/trajectory.hpp"

namespace landfix::platform {

/// How the estimate is moved, as one rigid body, before it is compared.
enum class Alignment : std::uint8_t {
  none,   ///< not at all: both are in the same frame
  first,  ///< its first pose onto the reference's
  se3,    ///< the least squares over all positions (Umeyama, without scale)
};

struct EvaluationOptions {
  Alignment alignment = Alignment::none;
  std::int64_t delta_ns = 1'000'000'000;  ///< between the two poses of a relative error
};

struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double max = 0.0;
};

/// Where there is nothing to measure, NaN.
struct Evaluation {
  std::size_t pairs = 0;       ///< poses of the estimate within the reference's time
  std::size_t unmatched = 0;   ///< poses of the estimate outside of it
  ErrorStatistics ate_m{};     ///< absolute: distance of the positions
  ErrorStatistics ate_deg{};   ///< absolute: angle of the relative rotation
  ErrorStatistics roll_deg{};  ///< magnitudes of the differences of the angles
  ErrorStatistics pitch_deg{};
  ErrorStatistics heading_deg{};
  ErrorStatistics elevation_m{};  ///< magnitude of the difference in z
  std::size_t rpe_pairs = 0;
  ErrorStatistics rpe_m{};  ///< relative: error of the motion over `delta_ns`
  ErrorStatistics rpe_deg{};
};

/// The reference is interpolated at the estimate's times, never extrapolated. Throws std::runtime_error where
/// no pose can be compared, and where an alignment has no unique answer.
[[nodiscard]] Evaluation evaluate(std::span<const StampedPose> reference,
                                  std::span<const StampedPose> estimate,
                                  const EvaluationOptions& options = {});

}  // namespace landfix::platform
