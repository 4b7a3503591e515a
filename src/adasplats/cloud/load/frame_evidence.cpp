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

constexpr std::size_t kFilesOfFrames = 5, kPointsOfFrames = 7;  // every seventh point
// Poses this far from the origin distinguish scans around them from scans around the origin.
constexpr double kFarPose_m = 100;
constexpr double kFewerTimes = 3;  // ratio of distances that is conclusive
constexpr double kSamePlace_m = 0.05, kSameTurn_rad = 0.5 * kDegree;

std::string with_figures(const char* format, double a, double b, double c) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), format, a, b, c);
  return text.data();
}

/// Some scans: their points as given, and as seen from the poses if they are in world coordinates.
struct FrameSample {
  std::vector<Vec3d> as_given, from_poses;
  double given_m = 0, posed_m = 0;  ///< distance of median points from the origin and the poses
  double min_pose_m = 0;            ///< from the origin
};

FrameSample sample_scans(const SensorFrames& frames) {
  FrameSample sample;
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
      if (!is_valid_position(p)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) along[axis].push_back(p[static_cast<int>(axis)]);
      const RigidTransform at =
          timed && std::isfinite(scan.times[i])
              ? interpolate(frames.poses.track, frames.times.time_s(scan.times[i], pose.time_s))
              : pose.world_from_sensor;
      sample.as_given.push_back(p);
      sample.from_poses.push_back(at.inverse() * p);
    }
    if (along[0].empty()) continue;
    const Vec3d middle = {upper_median_of(along[0]), upper_median_of(along[1]),
                          upper_median_of(along[2])};
    given_m.push_back(length(middle));
    posed_m.push_back(length(middle - pose.world_from_sensor.translation));
    poses_m.push_back(length(pose.world_from_sensor.translation));
  }
  if (given_m.empty()) return sample;
  sample.given_m = upper_median_of(given_m);
  sample.posed_m = upper_median_of(posed_m);
  sample.min_pose_m = *std::ranges::min_element(poses_m);
  return sample;
}

/// By pairs of scans; found: inconclusive.
FrameVerdict by_pairs(const SensorFrames& frames, const Executor& executor) {
  KittiSequence sequence;
  sequence.folder = frames.files.front().parent_path();
  sequence.scans = frames.files;
  sequence.trajectory = frames.poses.of_scans;
  sequence.reader = raw_reader(frames.source);
  const PoseEvidence evidence = weigh_poses(sequence, executor);
  constexpr std::size_t kUnmoved = 1;  // of PoseEvidence::met
  const std::string figures = with_figures(
      "of %.0f points on upright objects %.0f %% align with another scan by the poses, %.0f %% "
      "without",
      static_cast<double>(evidence.points), 100 * evidence.share(0),
      100 * evidence.share(kUnmoved));
  if (evidence.contradicts())
    return {evidence.best_other() == kUnmoved ? PointsIn::world : PointsIn::sensor, figures};
  if (evidence.confirms()) return {PointsIn::sensor, figures};
  return {PointsIn::found,
          evidence.points == 0 ? "no pairs of scans 3 to 15 m apart can be compared" : figures};
}

/// By the cones of beams.
FrameVerdict by_cones(const FrameSample& sample, const Executor& executor) {
  std::vector<SensorCones> tables = library_cones();
  const auto given = recognize_sensor(sample.as_given, tables, executor);
  if (given) tables = {given->cones};  // compare frames, not sensors
  const auto posed = recognize_sensor(sample.from_poses, tables, executor);
  if (!given && !posed) return {PointsIn::found, "no sensor is recognised by its beams"};
  const auto degrees = [](const std::optional<Recognition>& found) {
    return found ? found->residual_rad / kDegree : 0.5;  // the cap of recognize_sensor
  };
  const std::string sensor = given ? given->cones.sensor : posed->cones.sensor;
  const std::string figures = with_figures(
      "points are %.3f deg from the cones of its beams as given, at least %.3f as seen from the "
      "poses",
      degrees(given), degrees(posed), 0);
  constexpr double kNearer = 0.7;
  PointsIn where = PointsIn::found;
  if (!posed || (given && degrees(given) < kNearer * degrees(posed))) where = PointsIn::sensor;
  if (!given || (posed && degrees(posed) < kNearer * degrees(given))) where = PointsIn::world;
  return {where, sensor + ": " + figures};
}

FrameVerdict by_middles(const FrameSample& sample) {
  const std::string figures = with_figures(
      "the median points of the scans are %.1f m from the origin and %.1f m from the poses, which "
      "are at least %.1f m from the origin",
      sample.given_m, sample.posed_m, sample.min_pose_m);
  if (sample.given_m > kFarthestOriginM) return {PointsIn::world, figures};
  if (sample.min_pose_m < kFarPose_m) return {PointsIn::found, figures};
  if (kFewerTimes * sample.given_m < sample.posed_m) return {PointsIn::sensor, figures};
  if (kFewerTimes * sample.posed_m < sample.given_m) return {PointsIn::world, figures};
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
  const FrameSample sample = sample_scans(frames);
  FrameVerdict middles = by_middles(sample);
  if (sample.given_m > kFarthestOriginM) return middles;
  FrameVerdict pairs = by_pairs(frames, executor);
  if (pairs.points_in != PointsIn::found) return pairs;
  FrameVerdict cones = by_cones(sample, executor);
  if (cones.points_in != PointsIn::found) return cones;
  if (middles.points_in != PointsIn::found) return middles;
  if (are_all_identity(frames.poses.of_scans))
    return {PointsIn::sensor, "all poses are the identity, so both frames are the same"};
  return {PointsIn::found, pairs.because + "; " + cones.because + "; " + middles.because};
}

}  // namespace adasplats
