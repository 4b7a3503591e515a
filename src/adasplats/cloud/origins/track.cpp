// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/track.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr double kGapInPoses = 10, kMinGap_s = 1;

/// Where the sensor is `ahead_s` behind the pose `at` (before it where that is negative), as fast
/// as from its neighbour `from`; it turns on by as much as between them at most.
TimedPose run_out(const TimedPose& at, const TimedPose& from, double ahead_s) {
  TimedPose pose = at;
  const Vec3d way = at.world_from_sensor.translation - from.world_from_sensor.translation;
  const double share = ahead_s / (at.time_s - from.time_s);  // of the way between them
  pose.time_s += ahead_s;
  pose.world_from_sensor.translation = at.world_from_sensor.translation + share * way;
  const Trajectory turn = {
      {0, {}},
      {1, {from.world_from_sensor.rotation.transposed() * at.world_from_sensor.rotation, {}}}};
  pose.world_from_sensor.rotation =
      at.world_from_sensor.rotation * interpolate(turn, share).rotation;
  return pose;
}

}  // namespace

bool is_in_gap(const std::vector<TimeSpan>& gaps, TimeSpan span_s) {
  // The last gap that begins before the span ends.
  const auto after = std::ranges::lower_bound(gaps, span_s.last, {}, &TimeSpan::first);
  return after != gaps.begin() && span_s.first < std::prev(after)->last;
}

bool Track::covers(TimeSpan span_s) const {
  const TimeSpan all = covered_s();
  return span_s.first >= all.first && span_s.last <= all.last && !is_in_gap(gaps, span_s);
}

double pose_distance_s(const Trajectory& poses) {
  std::vector<double> apart_s;
  for (std::size_t k = 1; k < poses.size(); ++k)
    apart_s.push_back(poses[k].time_s - poses[k - 1].time_s);
  if (apart_s.empty()) return 0;
  return upper_median_of(apart_s);
}

Track track_of(const Trajectory& given) {
  Track track;
  track.measured_s = {given.front().time_s, given.back().time_s};
  const double apart_s = pose_distance_s(given);
  const double gap_s = std::max(kGapInPoses * apart_s, kMinGap_s);
  const auto is_gap = [&](std::size_t k) {  // behind pose k
    return k + 1 < given.size() && given[k + 1].time_s - given[k].time_s > gap_s;
  };
  for (std::size_t k = 0; k < given.size(); ++k) {
    const bool begins = k == 0 || is_gap(k - 1), ends = k + 1 == given.size() || is_gap(k);
    if (begins && !ends) track.poses.push_back(run_out(given[k], given[k + 1], -apart_s));
    track.poses.push_back(given[k]);
    if (ends && !begins) track.poses.push_back(run_out(given[k], given[k - 1], apart_s));
    if (is_gap(k)) track.gaps.push_back({track.poses.back().time_s, given[k + 1].time_s - apart_s});
  }
  return track;
}

}  // namespace adasplats
