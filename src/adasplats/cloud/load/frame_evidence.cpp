// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/frame_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr std::size_t kFilesOfFrames = 5, kPointsOfFrames = 7;  // looked at: every seventh point
// Poses so far from the origin that the middles of scans around them and around the origin differ.
constexpr double kFarPose_m = 100;
constexpr double kFewerTimes = 3;  // nearer by that
constexpr double kSamePlace_m = 0.05, kSameTurn_rad = 0.5 * kDegree;

std::string with_figures(const char* format, double a, double b, double c) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), format, a, b, c);
  return text.data();
}

/// Some scans: their points as they stand and as seen from the poses, were they in the world.
struct Looks {
  std::vector<Vec3d> as_given, from_poses;
  double given_m = 0, posed_m = 0;  ///< of the middles of scans, from the origin and from the poses
  double min_pose_m = 0;            ///< from the origin
};

Looks look_at(const SensorFrames& frames) {
  Looks looks;
  std::vector<double> given_m, posed_m, poses_m;
  const std::size_t count = std::min(kFilesOfFrames, frames.files.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = (2 * k + 1) * frames.files.size() / (2 * count);
    const FileScan scan = frames.source->read(frames.files[index]);
    const TimedPose& pose = frames.poses.of_scans[index];
    const bool timed = frames.times.kind != PointTimes::Kind::none && frames.poses.has_times &&
                       !frames.poses.track.empty() && scan.times.size() == scan.size();
    std::array<std::vector<double>, 3> along;
    for (std::size_t i = 0; i < scan.size(); i += kPointsOfFrames) {
      const Vec3d p = scan.positions[i];
      if (!is_place(p)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) along[axis].push_back(p[static_cast<int>(axis)]);
      const RigidTransform at =
          timed && std::isfinite(scan.times[i])
              ? interpolate(frames.poses.track, frames.times.time_s(scan.times[i], pose.time_s))
              : pose.world_from_sensor;
      looks.as_given.push_back(p);
      looks.from_poses.push_back(at.inverse() * p);
    }
    if (along[0].empty()) continue;
    const Vec3d middle = {upper_median_of(along[0]), upper_median_of(along[1]),
                          upper_median_of(along[2])};
    given_m.push_back(length(middle));
    posed_m.push_back(length(middle - pose.world_from_sensor.translation));
    poses_m.push_back(length(pose.world_from_sensor.translation));
  }
  if (given_m.empty()) return looks;
  looks.given_m = upper_median_of(given_m);
  looks.posed_m = upper_median_of(posed_m);
  looks.min_pose_m = *std::ranges::min_element(poses_m);
  return looks;
}

/// By pairs of scans; found: these do not tell.
FrameVerdict by_pairs(const SensorFrames& frames, const Executor& executor) {
  KittiSequence sequence;
  sequence.folder = frames.files.front().parent_path();
  sequence.scans = frames.files;
  sequence.trajectory = frames.poses.of_scans;
  sequence.reader = raw_reader(frames.source);
  const PoseEvidence evidence = weigh_poses(sequence, executor);
  constexpr std::size_t kUnmoved = 1;  // of PoseEvidence::met
  const std::string figures = with_figures(
      "of %.0f points on upright things %.0f %% meet another scan by the poses, %.0f %% without",
      static_cast<double>(evidence.points), 100 * evidence.share(0),
      100 * evidence.share(kUnmoved));
  if (evidence.contradicts())
    return {evidence.best_other() == kUnmoved ? PointsIn::world : PointsIn::sensor, figures};
  if (evidence.confirms()) return {PointsIn::sensor, figures};
  return {PointsIn::found,
          evidence.points == 0 ? "no pairs of scans 3 to 15 m apart can be judged" : figures};
}

/// By the cones of beams.
FrameVerdict by_cones(const Looks& looks, const Executor& executor) {
  std::vector<SensorCones> tables = library_cones();
  const auto given = recognize_sensor(looks.as_given, tables, executor);
  if (given) tables = {given->cones};  // two makes are not told apart here, but two frames
  const auto posed = recognize_sensor(looks.from_poses, tables, executor);
  if (!given && !posed) return {PointsIn::found, "no sensor is recognised by its beams"};
  const auto degrees = [](const std::optional<Recognition>& found) {
    return found ? found->residual_rad / kDegree : 0.5;  // the cap of recognize_sensor
  };
  const std::string sensor = given ? given->cones.sensor : posed->cones.sensor;
  const std::string figures = with_figures(
      "points are %.3f deg from the cones of its beams as they stand, %.3f or more "
      "seen from the poses",
      degrees(given), degrees(posed), 0);
  constexpr double kNearer = 0.7;
  PointsIn where = PointsIn::found;
  if (!posed || (given && degrees(given) < kNearer * degrees(posed))) where = PointsIn::sensor;
  if (!given || (posed && degrees(posed) < kNearer * degrees(given))) where = PointsIn::world;
  return {where, sensor + ": " + figures};
}

FrameVerdict by_middles(const Looks& looks) {
  const std::string figures = with_figures(
      "the middles of the scans are %.1f m from the origin, %.1f m from the poses, "
      "these %.1f m or more from the origin",
      looks.given_m, looks.posed_m, looks.min_pose_m);
  if (looks.given_m > kFarthestOriginM) return {PointsIn::world, figures};
  if (looks.min_pose_m < kFarPose_m) return {PointsIn::found, figures};
  if (kFewerTimes * looks.given_m < looks.posed_m) return {PointsIn::sensor, figures};
  if (kFewerTimes * looks.posed_m < looks.given_m) return {PointsIn::world, figures};
  return {PointsIn::found, figures};
}

bool are_all_identity(const Trajectory& poses) {
  return std::ranges::all_of(poses, [](const TimedPose& pose) {
    return length(pose.world_from_sensor.translation) < kSamePlace_m &&
           angle_between(pose.world_from_sensor.rotation, Mat3d{}) < kSameTurn_rad;
  });
}

}  // namespace

FrameVerdict find_frame(const SensorFrames& frames, const Executor& executor) {
  const Looks looks = look_at(frames);
  FrameVerdict middles = by_middles(looks);
  if (looks.given_m > kFarthestOriginM) return middles;
  FrameVerdict pairs = by_pairs(frames, executor);
  if (pairs.points_in != PointsIn::found) return pairs;
  FrameVerdict cones = by_cones(looks, executor);
  if (cones.points_in != PointsIn::found) return cones;
  if (middles.points_in != PointsIn::found) return middles;
  if (are_all_identity(frames.poses.of_scans))
    return {PointsIn::sensor, "the poses are the identity, so that both are one"};
  return {PointsIn::found, pairs.because + "; " + cones.because + "; " + middles.because};
}

}  // namespace adasplats
