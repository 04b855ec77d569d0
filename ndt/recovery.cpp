#include "ndt/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace landfix::ndt {
namespace {

constexpr double kShareOfNewest = 0.1;  // of what is usually explained
constexpr std::size_t kGuessesBetweenLooksAtTheClock = 64;
/// A second sweep is looked for within this, as the velocity of the first is a guess; a third by its motion.
constexpr double kFirstStep_m = 3.0;
constexpr double kStep_m = 0.6;
constexpr double kStep_rad = 0.08;
/// Between sweeps that are held against each other.
constexpr double kShortestStep_s = 0.04;
constexpr double kLongestStep_s = 0.5;
/// Of sweeps that agree: a false place jumps about.
constexpr double kAgreement_m = 0.25;
constexpr double kAgreement_rad = 0.03;
/// Of a road vehicle, which hardly reverses and hardly slips.
constexpr double kFastestReverse_mps = 3.0;
constexpr double kFastestSlip_mps = 1.5;
constexpr double kUsualPeriod_s = 0.1;
constexpr double kLongestWay_s = 20.0;  ///< at the same speed and curve
/// What another place must be better by, to be followed instead.
constexpr double kClearlyBetter = 0.05;
constexpr double kElsewhere_m = 1.0;
/// Of the road where the vehicle may be, to where it was.
constexpr double kGroundWithin_m = 2.0;
constexpr double kSteepest = 0.1;
/// Of what tells the height, to the map's; one level of a road is farther from the next.
constexpr double kAltitudeWithin_m = 3.0;
/// Of what tells the heading.
constexpr double kHeadingWithin_rad = 0.1;

[[nodiscard]] double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

[[nodiscard]] double likelihood_of(const MatchResult& match) noexcept {
  return match.nearest_voxel_likelihood / match.best_likelihood;
}

[[nodiscard]] double matched_share_of(const MatchResult& match) noexcept {
  return static_cast<double>(match.points_matched) / static_cast<double>(match.points);
}

/// How much of the scan the map explains, and how well: at a wrong place it is both.
[[nodiscard]] double explained_by(const MatchResult& match) noexcept {
  return likelihood_of(match) * matched_share_of(match);
}

[[nodiscard]] double distance_m(const Pose& a, const Pose& b) noexcept {
  return (a.translation() - b.translation()).norm();
}

[[nodiscard]] bool is_drivable(const Velocity& velocity) noexcept {
  return velocity[0] > -kFastestReverse_mps && std::abs(velocity[1]) < kFastestSlip_mps;
}

}  // namespace

void Recovery::remember(const StampedPose& at, const Velocity& velocity, const MatchResult& match) noexcept {
  const double explained = explained_by(match);
  usual_explained_ =
      has_been_seen_ ? usual_explained_ + kShareOfNewest * (explained - usual_explained_) : explained;
  has_been_seen_ = true;
  last_seen_ = at.pose;
  last_velocity_ = velocity_ = velocity;
  last_stamp_utc_ns_ = at.stamp_utc_ns;
  passed_s_ = counted_s_ = 0.0;
  track_ = {};
}

Sighting Recovery::look(Matcher& matcher, const VoxelMap& map, std::span<const Eigen::Vector3f> points_m,
                        const StampedPose& prediction, const std::optional<PoseGuess>& guess,
                        const Deadline& deadline) noexcept {
  const std::int64_t stamp_utc_ns = prediction.stamp_utc_ns;
  pass_time(stamp_utc_ns);
  undistorted_with_ = velocity_;
  Sighting sighting;
  sighting.before = track_.at;
  const double step_s = seconds_between(track_.at.stamp_utc_ns, stamp_utc_ns);
  if (track_.sweeps != 0 && step_s > 0.0 && step_s < kShortestStep_s) return sighting;  // a splinter
  if (track_.sweeps != 0) {
    const Pose expected = predict(track_.at, velocity_, stamp_utc_ns);
    sighting.match = matcher.match(map, points_m, expected, std::nullopt, deadline);
    const bool goes_on = step_s > 0.0 && step_s < kLongestStep_s;
    if (!goes_on || !follow(sighting.match, {stamp_utc_ns, expected})) drop_track();
    sighting.confirmed = track_.agreeing >= settings_.agreeing_sweeps;
    if (sighting.confirmed) return sighting;
  }

  std::optional<MatchResult> best;
  const auto consider = [&](const Pose& from) {
    if (deadline.has_passed()) return;
    const MatchResult match = matcher.match(map, points_m, from, std::nullopt, deadline);
    if (is_good(match) && (!best || explained_by(match) > explained_by(*best))) best = match;
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

  const bool is_better = track_.sweeps == 0 || (explained_by(*best) > track_.explained + kClearlyBetter &&
                                                distance_m(best->pose, track_.at.pose) > kElsewhere_m);
  if (is_better) {
    drop_track();
    track_ = {.at = {stamp_utc_ns, best->pose},
              .explained = explained_by(*best),
              .sweeps = 1,
              .undistorted_with = undistorted_with_};
    sighting.match = *best;
  }
  return sighting;
}

/// By the clock, and without its leaps.
void Recovery::pass_time(std::int64_t stamp_utc_ns) noexcept {
  const double duration_s = seconds_between(last_stamp_utc_ns_, stamp_utc_ns);
  last_stamp_utc_ns_ = stamp_utc_ns;
  passed_s_ += std::max(0.0, duration_s);
  counted_s_ += std::clamp(duration_s, 0.0, kUsualPeriod_s);
}

void Recovery::drop_track() noexcept {
  track_ = {};
  velocity_ = last_velocity_;
}

double Recovery::least_explained() const noexcept {
  return has_been_seen_ ? settings_.usual_share * usual_explained_ : settings_.least_explained;
}

bool Recovery::is_good(const MatchResult& match) const noexcept {
  return match.converged && likelihood_of(match) >= settings_.good_likelihood &&
         matched_share_of(match) >= settings_.good_matched_share;
}

/// Whether what was seen is seen again, where it should be by now.
bool Recovery::follow(const MatchResult& match, const StampedPose& expected) noexcept {
  const bool is_first_step = track_.sweeps == 1;
  const double off_m = distance_m(match.pose, expected.pose);
  const double off_rad = angle_between(match.pose, expected.pose);
  if (!is_good(match) || off_m > (is_first_step ? kFirstStep_m : kStep_m) || off_rad > kStep_rad)
    return false;
  StampedPose at{expected.stamp_utc_ns, match.pose};
  velocity_ = steady_part(velocity_between(track_.at, at));
  if (is_first_step) undo_wrong_distortion(at);
  const bool agrees = !is_first_step && off_m < kAgreement_m && off_rad < kAgreement_rad &&
                      match.weak.count == 0 && is_drivable(velocity_) &&
                      explained_by(match) >= least_explained();
  track_ = {.at = at,
            .explained = explained_by(match),
            .sweeps = track_.sweeps + 1,
            .agreeing = agrees ? track_.agreeing + 1 : 0};
  return true;
}

/// A sweep that was undistorted with a velocity that is wrong seems to be where it was half a turn before its
/// end, by what the velocity is wrong. That of the first two is no more than a guess.
void Recovery::undo_wrong_distortion(StampedPose& second) noexcept {
  const double half_s = 0.5 * seconds_between(track_.at.stamp_utc_ns, second.stamp_utc_ns);
  velocity_ -= 0.5 * (undistorted_with_ - track_.undistorted_with);
  second.pose = second.pose * pose_exp(half_s * (velocity_ - undistorted_with_));
}

void Recovery::search_on_way(const VoxelMap& map, const Landmarks& landmarks, std::size_t guesses,
                             const Deadline& deadline, Ranked& ranked) noexcept {
  const double farthest_m = reach_m(last_velocity_[0], passed_s_);
  search(map, landmarks, last_seen_, guesses, deadline, ranked,
         [&] { return sequence_.next_on_way(farthest_m); });
}

void Recovery::search_around(const PoseGuess& guess, const VoxelMap& map, const Landmarks& landmarks,
                             std::size_t guesses, const Deadline& deadline, Ranked& ranked) noexcept {
  const double heading_rad = guess.yaw_rad ? kHeadingWithin_rad : std::numbers::pi;
  Eigen::Vector3d place_m;
  place_m << guess.position_m, guess.height_m.value_or(0.0);
  std::optional<double> height_m;
  if (guess.height_m) height_m = ground_m(map, place_m, kAltitudeWithin_m);
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
  constexpr double kNeighbours_m = 1.5;
  constexpr double kNeighbours_rad = 0.15;
  if (guess.hits == 0 || (count == kMatches && guess.hits <= best[count - 1].hits)) return;
  std::size_t place = 0;
  for (; place < count && best[place].hits >= guess.hits; ++place) {
    if (distance_m(best[place].pose, guess.pose) < kNeighbours_m &&
        angle_between(best[place].pose, guess.pose) < kNeighbours_rad)
      return;
  }
  count = std::min(count + 1, kMatches);
  std::shift_right(best.begin() + static_cast<std::ptrdiff_t>(place),
                   best.begin() + static_cast<std::ptrdiff_t>(count), 1);
  best[place] = guess;
}

}  // namespace landfix::ndt
