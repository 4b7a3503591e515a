// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adasplats/core/maths/small_motion.h"

namespace adasplats {
namespace {

/// How far from the way between two given positions a third one of the same drive may be: what a
/// vehicle that brakes or turns does to the straight line, and the noise of poses.
constexpr double kShareOfWay = 0.25, kLeastAside_m = 0.5;

PoseCorrection between(const PoseCorrection& a, const PoseCorrection& b, double share,
                       double time_s, Vec3d position) {
  return {time_s, position, a.rotation_rad + share * (b.rotation_rad - a.rotation_rad),
          a.shift_m + share * (b.shift_m - a.shift_m)};
}

bool leads_past(const PoseCorrection& a, const PoseCorrection& b, double share, Vec3d position) {
  const Vec3d way = b.position - a.position;
  const double aside_m = length(position - (a.position + share * way));
  return aside_m <= kLeastAside_m + kShareOfWay * length(way) * std::max(1.0, std::fabs(share));
}

}  // namespace

RigidTransform PoseCorrection::corrected_from_given() const {
  return moved_about(position, rotation_rad, shift_m);
}

std::optional<PoseCorrection> Calibration::at(double time_s, Vec3d position) const {
  for (const PoseCorrection& pose : poses)
    if (pose.time_s == time_s && pose.position == position) return pose;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const PoseCorrection& a = poses[k];
    const PoseCorrection& b = poses[k + 1];
    const double apart_s = b.time_s - a.time_s;
    if (!(apart_s > 0)) continue;  // another drive begins
    const bool is_first = k == 0 || !(a.time_s > poses[k - 1].time_s);
    const bool is_last = k + 2 == poses.size() || !(poses[k + 2].time_s > b.time_s);
    const double share = (time_s - a.time_s) / apart_s;
    if (share < (is_first ? -1.0 : 0.0) || share > (is_last ? 2.0 : 1.0)) continue;
    if (leads_past(a, b, share, position))
      return between(a, b, std::clamp(share, 0.0, 1.0), time_s, position);
  }
  return std::nullopt;
}

CalibrationSizes sizes_of(const Calibration& calibration) {
  CalibrationSizes sizes;
  for (const PoseCorrection& pose : calibration.poses) {
    sizes.largest_rotation_rad = std::max(sizes.largest_rotation_rad, length(pose.rotation_rad));
    sizes.largest_shift_m = std::max(sizes.largest_shift_m, length(pose.shift_m));
  }
  const auto rms = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
  };
  sizes.range_rms_m = rms(calibration.lasers.range_m);
  sizes.elevation_rms_rad = rms(calibration.lasers.elevation_rad);
  return sizes;
}

bool apply(const Calibration& calibration, Trajectory& poses) {
  Trajectory corrected = poses;
  for (TimedPose& pose : corrected) {
    const auto correction = calibration.at(pose.time_s, pose.world_from_sensor.translation);
    if (!correction) return false;
    pose.world_from_sensor = correction->corrected_from_given() * pose.world_from_sensor;
  }
  poses = std::move(corrected);
  return true;
}

bool apply(const Calibration& calibration, PointCloud& cloud, const Executor& executor) {
  if (missing_for_calibration(cloud) != nullptr) return false;
  const Trajectory given = cloud.scan_poses;
  if (!apply(calibration, cloud.scan_poses)) return false;
  const auto local = [&](RigidTransform pose) {
    pose.translation = pose.translation - cloud.origin;
    return pose;
  };
  std::vector<RigidTransform> corrections;
  std::vector<Vec3d> axes;
  for (std::size_t scan = 0; scan < given.size(); ++scan) {
    const RigidTransform before = local(given[scan].world_from_sensor);
    corrections.push_back(local(cloud.scan_poses[scan].world_from_sensor) * before.inverse());
    axes.push_back(before.rotation * Vec3d{0, 0, 1});
  }
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t scan = cloud.scan_indices[i];
      const Vec3d sensor = vec_cast<double>(cloud.sensor_positions[i]);
      const Vec3d point =
          calibration.lasers.corrected(sensor, vec_cast<double>(cloud.positions[i]), axes[scan],
                                       cloud.lasers.empty() ? kNoLaser : cloud.lasers[i]);
      cloud.positions[i] = vec_cast<float>(corrections[scan] * point);
      cloud.sensor_positions[i] = vec_cast<float>(corrections[scan] * sensor);
    }
  });
  return true;
}

bool apply(const Calibration& calibration, KittiSequence& sequence) {
  if (!apply(calibration, sequence.trajectory)) return false;
  sequence.beams.offsets = calibration.lasers;
  return true;
}

const char* missing_for_calibration(const PointCloud& cloud) {
  if (!cloud.has_beams()) return "no sensor positions";
  if (cloud.scan_poses.size() < 2 || cloud.scan_indices.empty()) return "no scans with a pose each";
  for (const std::uint32_t scan : cloud.scan_indices)
    if (scan >= cloud.scan_poses.size()) return "scans without a pose";
  return nullptr;
}

}  // namespace adasplats
