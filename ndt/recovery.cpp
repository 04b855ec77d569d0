#include "ndt/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace landfix::ndt {
namespace {

constexpr double kShareOfNewest = 0.1;  // of what is usually explained
constexpr std::size_t kGuessesBetweenLooksAtTheClock = 64;
constexpr double kUsualPeriod_s = 0.1;
constexpr double kLongestWay_s = 20.0;  ///< at the same speed and curve
/// What another place must be better by, to be followed instead.
constexpr double kClearlyBetter = 0.05;
constexpr double kElsewhere_m = 1.0;
/// Of what was found elsewhere, to where it should be by the next sweep.
constexpr double kFoundWithin_m = 0.6;
constexpr double kVelocityWithin_mps = 1.0;
/// Of the road where the vehicle may be, to where it was.
constexpr double kGroundWithin_m = 2.0;
constexpr double kSteepest = 0.1;

[[nodiscard]] double distance_m(const Pose& a, const Pose& b) noexcept {
  return (a.translation() - b.translation()).norm();
}

}  // namespace

void Recovery::remember(const StampedPose& at, const Velocity& velocity, const MatchResult& match) noexcept {
  const double explained = match.explained();
  usual_explained_ =
      has_been_seen_ ? usual_explained_ + kShareOfNewest * (explained - usual_explained_) : explained;
  has_been_seen_ = true;
  last_seen_ = at.pose;
  last_velocity_ = velocity;
  last_stamp_utc_ns_ = at.stamp_utc_ns;
  passed_s_ = counted_s_ = 0.0;
  track_.drop();
}

Sighting Recovery::look(Matcher& matcher, const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                        const StampedPose& prediction, const Velocity& undistorted_with,
                        const std::optional<PoseGuess>& guess, const Deadline& deadline) noexcept {
  const std::int64_t stamp_utc_ns = prediction.stamp_utc_ns;
  pass_time(stamp_utc_ns);
  Sighting sighting;
  sighting.before = track_.at();
  if (track_.exists()) {
    if (track_.is_splinter(stamp_utc_ns)) return sighting;
    const StampedPose expected{stamp_utc_ns, track_.expected_at(stamp_utc_ns)};
    sighting.match = matcher.match(map, points_m, expected.pose, std::nullopt, deadline);
    track_.follow(sighting.match, expected, undistorted_with, least_explained());
    sighting.confirmed = track_.agreeing() >= settings_.agreeing_sweeps;
    if (sighting.confirmed) return sighting;
  }

  std::optional<MatchResult> best;
  const auto consider = [&](const Pose& from) {
    if (deadline.has_passed()) return;
    const MatchResult match = matcher.match(map, points_m, from, std::nullopt, deadline);
    const bool is_good = judge(match, settings_.gates) == Fit::good;
    if (is_good && (!best || match.explained() > best->explained())) best = match;
  };
  const Landmarks landmarks(points_m);
  Ranked ranked;
  if (has_been_seen_) {
    consider(prediction.pose);
    // As if it had gone on, by the sweeps that came, and by the clock, which may have been set.
    consider(last_seen_ * pose_exp(counted_s_ * last_velocity_));
    if (passed_s_ < kLongestWay_s) consider(last_seen_ * pose_exp(passed_s_ * last_velocity_));
    search_on_way(map, landmarks, guess ? settings_.guesses / 2 : settings_.guesses, deadline, ranked);
  }
  if (guess) {
    search_around(*guess, map, landmarks, has_been_seen_ ? settings_.guesses / 2 : settings_.guesses,
                  deadline, ranked);
  }
  for (const RankedGuess& each : std::span(ranked.best).first(ranked.count)) consider(each.pose);
  if (!best) return sighting;

  const bool is_better = !track_.exists() || (best->explained() > track_.explained() + kClearlyBetter &&
                                              distance_m(best->pose, track_.at().pose) > kElsewhere_m);
  if (is_better) {
    track_.begin({stamp_utc_ns, best->pose}, best->explained(), last_velocity_, undistorted_with);
    sighting.match = *best;
  }
  return sighting;
}

Sighting Recovery::check(Matcher& matcher, const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                         std::int64_t stamp_utc_ns, const Found& found, const Velocity& undistorted_with,
                         const Deadline& deadline) noexcept {
  if ((undistorted_with - found.velocity).head<3>().norm() > kVelocityWithin_mps) {
    last_velocity_ = found.velocity;
    track_.drop();
    return {};
  }
  const Pose expected = predict(found.at, found.velocity, stamp_utc_ns);
  const MatchResult match = matcher.match(map, points_m, expected, std::nullopt, deadline);
  const bool is_there = judge(match, settings_.gates) == Fit::good && match.weak.count == 0 &&
                        match.explained() >= least_explained() &&
                        distance_m(match.pose, expected) < kFoundWithin_m;
  return {.match = match, .before = found.at, .confirmed = is_there};
}

/// By the clock, and without its leaps.
void Recovery::pass_time(std::int64_t stamp_utc_ns) noexcept {
  const double duration_s = seconds_between(last_stamp_utc_ns_, stamp_utc_ns);
  last_stamp_utc_ns_ = stamp_utc_ns;
  passed_s_ += std::max(0.0, duration_s);
  counted_s_ += std::clamp(duration_s, 0.0, kUsualPeriod_s);
}

double Recovery::least_explained() const noexcept {
  return has_been_seen_ ? settings_.usual_share * usual_explained_ : settings_.least_explained;
}

void Recovery::search_on_way(const VoxelMap& map, const Landmarks& landmarks, std::size_t guesses,
                             const Deadline& deadline, Ranked& ranked) noexcept {
  const double farthest_m = reach_m(last_velocity_[0], passed_s_);
  search(map, landmarks, last_seen_, guesses, deadline, ranked,
         [&] { return sequence_.next_on_way(farthest_m); });
}

void Recovery::search_around(const PoseGuess& guess, const VoxelMap& map, const Landmarks& landmarks,
                             std::size_t guesses, const Deadline& deadline, Ranked& ranked) noexcept {
  const double heading_rad = guess.yaw_rad ? PoseGuess::kYawWithin_rad : std::numbers::pi;
  Eigen::Vector3d place_m;
  place_m << guess.position_m, guess.height_m.value_or(0.0);
  std::optional<double> height_m;
  if (guess.height_m) height_m = ground_m(map, place_m, PoseGuess::kHeightWithin_m);
  if (!height_m) height_m = lowest_m(map, guess.position_m, guess.within_m);
  if (!height_m) return;  // beyond the map
  place_m.z() = *height_m;
  search(map, landmarks, make_pose(place_m, {.yaw_rad = guess.yaw_rad.value_or(0.0)}), guesses, deadline,
         ranked, [&] { return sequence_.next_around(guess.within_m, heading_rad); });
}

template <class NextWay>
void Recovery::search(const VoxelMap& map, const Landmarks& landmarks, const Pose& from, std::size_t guesses,
                      const Deadline& deadline, Ranked& ranked, NextWay next_way) noexcept {
  const Eigen::Vector3d origin_m = from.translation();
  const double yaw_rad = to_roll_pitch_yaw(from.linear()).yaw_rad;
  const Eigen::Rotation2Dd to_map(yaw_rad);
  const double above_ground_m =
      origin_m.z() - ground_m(map, origin_m, kGroundWithin_m).value_or(origin_m.z());
  for (std::size_t i = 0; i < guesses; ++i) {
    if (i % kGuessesBetweenLooksAtTheClock == 0 && deadline.has_passed()) break;
    const Eigen::Vector3d way = next_way();
    Eigen::Vector3d place_m = origin_m;
    place_m.head<2>() += to_map * way.head<2>();
    const auto height_m = ground_m(map, place_m, kGroundWithin_m + kSteepest * way.head<2>().norm());
    if (!height_m) continue;  // no road there
    place_m.z() = *height_m + above_ground_m;
    const Pose pose = on_slope(map, make_pose(place_m, {.yaw_rad = yaw_rad + way.z()}));
    ranked.add({.pose = pose, .hits = landmarks.hits(map, pose)});
  }
}

/// Of neighbours the best alone: they would lead to the same place.
void Recovery::Ranked::add(const RankedGuess& guess) noexcept {
  constexpr double kApart_m = 1.5;
  constexpr double kApart_rad = 0.15;
  if (guess.hits == 0 || (count == kMatches && guess.hits <= best[count - 1].hits)) return;
  std::size_t place = 0;
  for (; place < count && best[place].hits >= guess.hits; ++place) {
    if (distance_m(best[place].pose, guess.pose) < kApart_m &&
        angle_between(best[place].pose, guess.pose) < kApart_rad)
      return;
  }
  count = std::min(count + 1, kMatches);
  std::shift_right(best.begin() + static_cast<std::ptrdiff_t>(place),
                   best.begin() + static_cast<std::ptrdiff_t>(count), 1);
  best[place] = guess;
}

}  // namespace landfix::ndt
