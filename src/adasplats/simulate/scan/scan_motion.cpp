// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxKnots = 64;
constexpr double kMaxTurn_rad = 0.5 * std::numbers::pi / 180;

/// Between which two knots a share of the revolution is, and how far behind the first, 0..1.
struct KnotPlace {
  std::size_t segment;
  double late;
};

KnotPlace place_of(std::size_t knots, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(knots - 1);
  const std::size_t segment = std::min(static_cast<std::size_t>(place), knots - 2);
  return {segment, place - static_cast<double>(segment)};
}

/// Knots that a scan needs: as many segments as half degrees, and as poses of the motion.
std::size_t knots_needed(const Trajectory& motion, double begin_s, double end_s) {
  const auto by_time = [](const TimedPose& pose, double time_s) { return pose.time_s < time_s; };
  const auto first = std::lower_bound(motion.begin(), motion.end(), begin_s, by_time);
  const auto last = std::lower_bound(first, motion.end(), end_s, by_time);
  double turn_rad = 0;
  Mat3d before = interpolate(motion, begin_s).rotation;
  for (auto pose = first; pose != last; ++pose) {
    turn_rad += angle_between(before, pose->world_from_sensor.rotation);
    before = pose->world_from_sensor.rotation;
  }
  turn_rad += angle_between(before, interpolate(motion, end_s).rotation);
  const auto poses_inside = static_cast<std::size_t>(last - first);
  const double turns = std::ceil(turn_rad / kMaxTurn_rad);
  const auto segments = std::max<std::size_t>(poses_inside + 1, static_cast<std::size_t>(turns));
  return std::min(segments + 1, kMaxKnots);
}

}  // namespace

std::vector<ScanMotion> still_scans(std::span<const TimedPose> poses) {
  std::vector<ScanMotion> scans;
  scans.reserve(poses.size());
  for (const TimedPose& pose : poses) scans.push_back({pose, {}});
  return scans;
}

std::vector<ScanMotion> moving_scans(std::span<const TimedPose> poses, const Trajectory& given,
                                     double duration_s) {
  if (!(duration_s > 0)) throw Error(ErrorKind::usage, "a moving scan needs a positive duration");
  if (given.empty()) throw Error(ErrorKind::usage, "the motion has no poses");
  const Trajectory motion = with_extrapolated_ends(given, 0.5 * duration_s);
  std::vector<ScanMotion> scans;
  scans.reserve(poses.size());
  for (const TimedPose& pose : poses) {
    ScanMotion scan{pose, {}, duration_s};
    const double begin_s = pose.time_s - 0.5 * duration_s;
    const RigidTransform from_motion =
        pose.world_from_sensor * interpolate(motion, pose.time_s).inverse();
    const std::size_t knots = knots_needed(motion, begin_s, begin_s + duration_s);
    for (std::size_t k = 0; k < knots; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(knots - 1);
      scan.knots.push_back(from_motion * interpolate(motion, begin_s + share * duration_s));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::string motion_ends_note(std::span<const TimedPose> poses, const Trajectory& motion,
                             double duration_s) {
  const double begin_s = motion.front().time_s, end_s = motion.back().time_s;
  const auto outside = std::ranges::count_if(poses, [&](const TimedPose& pose) {
    return std::max(begin_s - pose.time_s, pose.time_s - end_s) > 0.5 * duration_s;
  });
  if (outside == 0) return {};
  return std::to_string(outside) + " of " + std::to_string(poses.size()) +
         " scans are outside the poses (" + decimal_text(begin_s) + " to " + decimal_text(end_s) +
         " s) and at rest";
}

RigidTransform pose_at(const ScanMotion& motion, double share) {
  if (motion.knots.size() < 2)
    return motion.knots.empty() ? motion.reference.world_from_sensor : motion.knots.front();
  const KnotPlace place = place_of(motion.knots.size(), share);
  const Trajectory ends = {{0.0, motion.knots[place.segment]},
                           {1.0, motion.knots[place.segment + 1]}};
  return interpolate(ends, place.late);
}

Vec3d world_point(std::span<const RigidTransform> knots, double share, Vec3d point) {
  const KnotPlace place = place_of(knots.size(), share);
  return (1 - place.late) * (knots[place.segment] * point) +
         place.late * (knots[place.segment + 1] * point);
}

std::vector<ScanPose> scan_poses(const ScanMotion& motion, Vec3d scene_origin) {
  if (motion.knots.empty()) return {scan_pose(motion.reference.world_from_sensor, scene_origin)};
  std::vector<ScanPose> poses;
  poses.reserve(motion.knots.size());
  for (const RigidTransform& knot : motion.knots) poses.push_back(scan_pose(knot, scene_origin));
  return poses;
}

}  // namespace adasplats
