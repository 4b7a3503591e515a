// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/clock_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/core/error.h"

namespace adasplats {

namespace {

constexpr std::size_t kMaxPoints = 200'000, kSweeps = 8, kMaxOfSweep = 200'000;
constexpr double kSweep_s = 0.1;

/// Times in the middles of eight parts with as many points each.
std::array<double, kSweeps> middles_of(const std::vector<TimedPoint>& points) {
  std::vector<double> times;
  times.reserve(points.size());
  for (const TimedPoint& point : points) times.push_back(point.time);
  std::ranges::sort(times);
  std::array<double, kSweeps> middles{};
  for (std::size_t s = 0; s < kSweeps; ++s)
    middles[s] = times[times.size() * (2 * s + 1) / (2 * kSweeps)];
  return middles;
}

void thin(std::vector<TimedPoint>& sweep) {
  const std::size_t every = sweep.size() / kMaxOfSweep + 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sweep.size(); i += every) sweep[kept++] = sweep[i];
  sweep.resize(kept);
}

}  // namespace

void TimedRecording::add(const std::string& file, std::span<const Vec3d> positions,
                         std::span<const double> times, DeclaredClock declared) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i])) {
      span_ = {std::min(span_.first, times[i]), std::max(span_.last, times[i])};
    } else if (is_finite(positions[i])) {
      throw Error(ErrorKind::data,
                  file + ": the time of point " + std::to_string(i) + " (from 0) is not finite");
    }
  }
  declared_ = files_.empty() || declared == declared_ ? declared : DeclaredClock::none;
  if (files_.empty()) first_name_ = file;
  files_.push_back({positions, times});
  size_ += times.size();
}

std::string TimedRecording::name() const {
  return first_name_ +
         (files_.size() > 1 ? " and " + std::to_string(files_.size() - 1) + " more" : "");
}

std::size_t TimedRecording::count_within(TimeSpan span_s, const ClockPair& clock) const {
  std::size_t points = 0;
  for (const File& file : files_)
    for (const double time : file.times) {
      const double time_s = clock.in_trajectory(time);
      if (time_s > span_s.first && time_s < span_s.last) ++points;
    }
  return points;
}

SweepSample TimedRecording::sample(double unit_s) const {
  SweepSample sample;
  const auto is_sound = [](const File& file, std::size_t i) {
    return is_finite(file.positions[i]) && std::isfinite(file.times[i]);
  };
  const std::size_t stride = size_ / kMaxPoints + 1;
  for (const File& file : files_)
    for (std::size_t i = 0; i < file.times.size(); i += stride)
      if (is_sound(file, i)) sample.points.push_back({file.positions[i], file.times[i]});
  if (sample.points.empty()) return sample;
  const auto middles = middles_of(sample.points);
  sample.sweeps.resize(kSweeps);
  for (const File& file : files_)
    for (std::size_t i = 0; i < file.times.size(); ++i)
      for (std::size_t s = 0; s < kSweeps; ++s)
        if (std::fabs(file.times[i] - middles[s]) * unit_s <= 0.5 * kSweep_s && is_sound(file, i))
          sample.sweeps[s].push_back({file.positions[i], file.times[i]});
  std::ranges::for_each(sample.sweeps, thin);
  return sample;
}

namespace {

constexpr double kMaxFar = 0.5;  // of the points
constexpr const char* kGiveOffset = "give `time_offset`, the seconds to add to the points' times";
constexpr const char* kTrustOrigins = "; `trust_origins` skips this check";

std::string fixed(double value, int digits) {
  std::array<char, 400> text{};  // the largest double has 309 digits before the point
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string span_text(TimeSpan span) { return fixed(span.first, 3) + " to " + fixed(span.last, 3); }

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

/// The sample with a quarter of its points, for many looks at it.
SweepSample quarter_of(const SweepSample& sample) {
  const auto thinned = [](const std::vector<TimedPoint>& points, std::size_t most) {
    const std::size_t every = points.size() / most + 1;
    std::vector<TimedPoint> kept;
    for (std::size_t i = 0; i < points.size(); i += every) kept.push_back(points[i]);
    return kept;
  };
  SweepSample quarter;
  quarter.points = thinned(sample.points, 50'000);
  for (const std::vector<TimedPoint>& sweep : sample.sweeps)
    quarter.sweeps.push_back(thinned(sweep, 20'000));
  return quarter;
}

}  // namespace

ClockFinder::ClockFinder(const TimedRecording& points, std::filesystem::path file,
                         const Trajectory& sensor, std::optional<double> stated_offset_s,
                         const Executor& executor)
    : points_(points),
      file_(std::move(file)),
      sensor_(sensor),
      stated_offset_s_(stated_offset_s),
      executor_(executor) {
  const double apart = pose_distance_s(sensor);
  padded_ = {sensor.front().time_s - apart, sensor.back().time_s + apart};
}

ClockPair ClockFinder::find() {
  if (stated_offset_s_) {
    ClockPair stated{"as stated", kTheSameClock, 1, 1, *stated_offset_s_};
    require_cover({stated});
    return stated;
  }
  const std::vector<ClockPair> possible =
      possible_clocks(points_.span(), points_.declared(), padded_);
  std::vector<ClockPair> covering;
  for (const ClockPair& clock : possible)
    if (covers(clock)) covering.push_back(clock);
  if (covering.empty()) require_cover(possible);
  return covering.size() == 1 ? covering.front() : clearest(covering);
}

Track ClockFinder::track(const ClockPair& clock) const {
  Trajectory poses = sensor_;
  for (TimedPose& pose : poses) pose.time_s *= clock.trajectory_unit_s;
  return track_of(poses);
}

SweepView ClockFinder::view(const ClockPair& clock) {
  return view_along(sample(clock.points_unit_s), clock, track(clock).poses, executor_);
}

TimeSpan ClockFinder::covered(const ClockPair& clock) const {
  return {padded_.first * clock.trajectory_unit_s, padded_.last * clock.trajectory_unit_s};
}

bool ClockFinder::covers(const ClockPair& clock) const {
  // What offsets of 1e9 s lose in doubles, on both sides.
  constexpr double kRounding_s = 1e-6;
  const TimeSpan times = clock.in_trajectory(points_.span()), poses = covered(clock);
  return times.first >= poses.first - kRounding_s && times.last <= poses.last + kRounding_s;
}

const SweepSample& ClockFinder::sample(double unit_s) {
  if (sample_unit_s_ != unit_s) sample_ = points_.sample(unit_s);
  sample_unit_s_ = unit_s;
  return sample_;
}

/// Throws with the figures of what comes nearest, where nothing covers all times.
void ClockFinder::require_cover(const std::vector<ClockPair>& possible) const {
  const ClockPair* best = nullptr;
  std::size_t most = 0;
  for (const ClockPair& clock : possible) {
    if (covers(clock)) return;
    const std::size_t points = points_.count_within(covered(clock), clock);
    if (points <= most) continue;
    most = points;
    best = &clock;
  }
  const std::string named =
      points_.name() + ": the trajectory " + file_.string() + " does not cover ";
  if (best == nullptr) {
    throw Error(ErrorKind::data,
                named + "the times of the points" +
                    (stated_offset_s_ ? " by the stated `time_offset`" : " by any known clock") +
                    ": points of " + span_text(points_.span()) + ", poses of " +
                    span_text({sensor_.front().time_s, sensor_.back().time_s}) +
                    "; it belongs to another recording, or to another clock: " + kGiveOffset);
  }
  const TimeSpan times = best->in_trajectory(points_.span());
  const TimeSpan poses = {sensor_.front().time_s * best->trajectory_unit_s,
                          sensor_.back().time_s * best->trajectory_unit_s};
  throw Error(ErrorKind::data,
              named + std::to_string(points_.size() - most) + " of " +
                  std::to_string(points_.size()) + " points (" + best->description() +
                  "): they are of " + span_text(times) + " s, its poses of " + span_text(poses) +
                  " s: up to " + fixed(std::max(0.0, poses.first - times.first), 3) +
                  " s before and " + fixed(std::max(0.0, times.last - poses.last), 3) +
                  " s after its poses. Remove these points, or give the complete trajectory; if "
                  "the clocks differ, " +
                  kGiveOffset);
}

/// Of several clocks the one that the sweeps fit. One clock for both is taken where nothing speaks
/// against it.
ClockPair ClockFinder::clearest(const std::vector<ClockPair>& covering) {
  std::vector<std::pair<double, const ClockPair*>> by_cost;
  bool has_evidence = true;
  for (const ClockPair& clock : covering) {
    const SweepView seen = view(clock);
    has_evidence = has_evidence && seen.points >= kMinEvidence;
    by_cost.emplace_back(seen.cost(), &clock);
  }
  const auto [one_cost, one] = by_cost.front();
  std::ranges::stable_sort(by_cost, {}, [](const auto& entry) { return entry.first; });
  const double least = by_cost[0].first;
  if (has_evidence && least + kClearlyLess <= by_cost[1].first) return *by_cost[0].second;
  const bool is_one_clock = one->offset_s == 0;
  if (is_one_clock && (!has_evidence || one_cost < least + kClearlyLess)) return *one;
  std::string list;
  for (const auto& entry : by_cost)
    list += "\n  " + entry.second->description() +
            (has_evidence ? ", misfit " + fixed(entry.first, 2) : "");
  throw Error(ErrorKind::data, points_.name() + ": the trajectory " + file_.string() +
                                   " covers all times by several clocks, and " +
                                   (has_evidence ? "the points fit none of them clearly best"
                                                 : "there are too few points to decide") +
                                   "; " + kGiveOffset + ":" + list);
}

/// A shift of the times by which the points would fit clearly better; 0: none.
double ClockFinder::better_shift_s(const ClockPair& clock) {
  const Trajectory poses = track(clock).poses;
  const SweepSample quarter = quarter_of(sample(clock.points_unit_s));
  // Parts of a second, and all that the scales of GPS, UTC and TAI differ by, in steps so small
  // that a better one is not stepped over.
  std::vector<double> steps_s = {0.3, 0.6, 37};
  for (int step_s = 1; step_s <= 20; ++step_s) steps_s.push_back(step_s);
  double best_s = 0;
  double least = view_along(quarter, clock, poses, executor_).cost() - kClearlyLess;
  for (const double step_s : steps_s)
    for (const double shift_s : {step_s, -step_s}) {
      ClockPair other = clock;
      other.offset_s += shift_s;
      if (!covers(other)) continue;
      const double cost = view_along(quarter, other, poses, executor_).cost();
      if (cost > least) continue;
      least = cost;
      best_s = shift_s;
    }
  return best_s;
}

/// Whether all is far to one side, and poses amid the points would fit better by far.
bool ClockFinder::is_aside(const ClockPair& clock, const SweepView& seen) {
  constexpr double kMinAside_m = 50, kByFar = 1;
  const Vec3d aside = {seen.median_way_m.x, seen.median_way_m.y, 0};
  if (length(aside) < kMinAside_m) return false;
  const SweepView moved =
      view_along(sample(clock.points_unit_s), clock, shifted(track(clock).poses, aside), executor_);
  return moved.cost() + kByFar < seen.cost();
}

void ClockFinder::check(const ClockPair& clock, const SweepView& seen, ProgressSink& progress) {
  if (seen.points < kMinEvidence) return;
  const std::string named = points_.name() + ": the trajectory " + file_.string() +
                            " does not fit the points (" + clock.description() + "): ";
  const std::string median = "the median range is " + fixed(seen.median_range_m, 1) + " m";
  if (seen.share_far > kMaxFar || seen.median_range_m > kFarthestOriginM)
    throw Error(ErrorKind::data,
                named + median + ", and " + percent(seen.share_far) +
                    " of the points are farther than " + fixed(kFarInStreets_m, 0) +
                    " m and not below the sensor; it belongs to another scene, frame or clock" +
                    kTrustOrigins);
  if (is_aside(clock, seen))
    throw Error(ErrorKind::data, named + median + ", and half of the points are " +
                                     fixed(seen.median_way_m.x, 0) + " m or more in x and " +
                                     fixed(seen.median_way_m.y, 0) +
                                     " m in y from the sensor; moved by that, it would fit clearly "
                                     "better: it belongs to another scene or frame" +
                                     kTrustOrigins);
  if (const double shift_s = better_shift_s(clock); shift_s != 0) {
    const std::string message =
        named + "with " + (shift_s > 0 ? "+" : "") + fixed(shift_s, 1) +
        " s added to the times of the points it fits clearly better; either the clocks differ by "
        "about that (" +
        kGiveOffset + "), or the axes of the poses are wrong";
    if (!stated_offset_s_) throw Error(ErrorKind::data, message + kTrustOrigins);
    progress.warn(message);
  }
  if (seen.share_behind > seen.max_behind())
    throw Error(
        ErrorKind::data,
        named + percent(seen.share_behind) +
            " of what was measured within 0.1 s is hidden behind other points as seen from "
            "there, expected at most " +
            percent(seen.max_behind()) +
            "; the mount of the sensor is wrong (`mount`), or the trajectory has other axes "
            "or units, or belongs to another scene or clock; " +
            median + kTrustOrigins);
}

void ClockFinder::require_no_gaps(const ClockPair& clock, const Track& track) const {
  for (const TimeSpan gap : track.gaps) {
    const std::size_t inside = points_.count_within(gap, clock);
    if (inside == 0) continue;
    throw Error(ErrorKind::data,
                points_.name() + ": " + std::to_string(inside) +
                    " points were measured in a gap of the trajectory " + file_.string() +
                    ", which has no poses from " + span_text(gap) +
                    " s; remove these points, or give a trajectory without the gap");
  }
}

}  // namespace adasplats
