// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/calibration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

/// Maximum distance of a pose from the straight line between two poses of its drive: allows for
/// braking, turning and the noise of poses.
constexpr double kShareOfWay = 0.25, kMinAside_m = 0.5;

ScanSpan drive_of(const std::vector<PoseCorrection>& poses, std::size_t scan) {
  ScanSpan drive{scan, scan + 1};
  while (drive.begin > 0 && poses[drive.begin].time_s > poses[drive.begin - 1].time_s)
    --drive.begin;
  while (drive.end < poses.size() && poses[drive.end].time_s > poses[drive.end - 1].time_s)
    ++drive.end;
  return drive;
}

/// A line fitted to the corrections of a drive over time, weighted about `time_s`, without the scan
/// `left_out`. The weighted mean if the weights leave only one scan.
PoseCorrection smoothed_at(const std::vector<PoseCorrection>& poses, ScanSpan drive, double time_s,
                           double smooth_s, std::size_t left_out) {
  double w = 0, wt = 0, wtt = 0;
  Vec3d rotation, shift, rotation_t, shift_t;
  for (std::size_t k = drive.begin; k < drive.end; ++k) {
    if (k == left_out) continue;
    const double t = poses[k].time_s - time_s;
    const double weight = std::exp(-0.5 * t * t / (smooth_s * smooth_s)) + 1e-9;
    w += weight;
    wt += weight * t;
    wtt += weight * t * t;
    rotation = rotation + weight * poses[k].rotation_rad;
    shift = shift + weight * poses[k].shift_m;
    rotation_t = rotation_t + (weight * t) * poses[k].rotation_rad;
    shift_t = shift_t + (weight * t) * poses[k].shift_m;
  }
  const double determinant = w * wtt - wt * wt;
  PoseCorrection result;
  result.time_s = time_s;
  if (determinant > 1e-6 * w * wtt) {
    result.rotation_rad = (1 / determinant) * (wtt * rotation - wt * rotation_t);
    result.shift_m = (1 / determinant) * (wtt * shift - wt * shift_t);
  } else {
    result.rotation_rad = (1 / w) * rotation;
    result.shift_m = (1 / w) * shift;
  }
  return result;
}

/// The correction between two scans; averaged over more scans if `smooth_s` is not 0.
PoseCorrection between(const std::vector<PoseCorrection>& poses, std::size_t first,
                       std::size_t second, double time_s, double smooth_s, std::size_t left_out) {
  const PoseCorrection& a = poses[first];
  const PoseCorrection& b = poses[second];
  const double held_s = std::clamp(time_s, a.time_s, b.time_s);
  if (smooth_s > 0) return smoothed_at(poses, drive_of(poses, first), held_s, smooth_s, left_out);
  const double share = (held_s - a.time_s) / (b.time_s - a.time_s);
  PoseCorrection result;
  result.rotation_rad = a.rotation_rad + share * (b.rotation_rad - a.rotation_rad);
  result.shift_m = a.shift_m + share * (b.shift_m - a.shift_m);
  return result;
}

bool passes_close(const PoseCorrection& a, const PoseCorrection& b, double share, Vec3d position) {
  const Vec3d way = b.position - a.position;
  const double aside_m = length(position - (a.position + share * way));
  return aside_m <= kMinAside_m + kShareOfWay * length(way) * std::max(1.0, std::fabs(share));
}

/// Median interval between consecutive scans of a drive; 0 if there are none.
double median_step_s(const std::vector<PoseCorrection>& poses) {
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < poses.size(); ++k)
    if (poses[k].time_s > poses[k - 1].time_s)
      steps_s.push_back(poses[k].time_s - poses[k - 1].time_s);
  if (steps_s.empty()) return 0;
  return upper_median_of(steps_s);
}

/// Squared errors of the correction of each inner scan of a drive when predicted from the others,
/// m^2.
std::vector<double> left_out_squares(const std::vector<PoseCorrection>& poses, double smooth_s) {
  constexpr double kArm_m = 10;  // rotations count as the displacement at this distance
  std::vector<double> squares;
  for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
    if (!(poses[k].time_s > poses[k - 1].time_s && poses[k + 1].time_s > poses[k].time_s)) continue;
    const PoseCorrection predicted = between(poses, k - 1, k + 1, poses[k].time_s, smooth_s, k);
    const double turn_m = kArm_m * length(predicted.rotation_rad - poses[k].rotation_rad);
    const double shift_m = length(predicted.shift_m - poses[k].shift_m);
    squares.push_back(turn_m * turn_m + shift_m * shift_m);
  }
  return squares;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

RigidTransform MountCorrection::given_from_mounted() const {
  return {rotation_by(rotation_rad), shift_m};
}

RigidTransform PoseCorrection::corrected_from_given() const {
  return moved_about(position, rotation_rad, shift_m);
}

bool Calibration::moves_scans() const {
  return !mount.empty() || std::ranges::any_of(poses, [](const PoseCorrection& pose) {
    return !(pose.rotation_rad == Vec3d{}) || !(pose.shift_m == Vec3d{});
  });
}

const Calibration* Calibration::of_sensor(std::string_view name) const {
  if (sensor.empty() || sensor == name) return this;
  const auto found = std::ranges::find(others, name, &Calibration::sensor);
  return found == others.end() ? nullptr : &*found;
}

std::optional<PoseCorrection> Calibration::at(double time_s, Vec3d position) const {
  return CorrectionLookup(*this).at(time_s, position);
}

std::optional<RigidTransform> Calibration::corrected(const TimedPose& given) const {
  return CorrectionLookup(*this).corrected(given);
}

CorrectionLookup::CorrectionLookup(const Calibration& calibration)
    : calibration_(calibration), drives_(drives_of(calibration.poses)) {}

std::size_t CorrectionLookup::first_not_before(ScanSpan drive, double time_s) const {
  const auto begin = calibration_.poses.begin();
  const auto found =
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(drive.begin),
                       begin + static_cast<std::ptrdiff_t>(drive.end), time_s,
                       [](const PoseCorrection& pose, double time) { return pose.time_s < time; });
  return static_cast<std::size_t>(found - begin);
}

std::optional<PoseCorrection> CorrectionLookup::at(double time_s, Vec3d position) const {
  std::vector<std::size_t> near;
  near.reserve(drives_.size());
  for (const ScanSpan& drive : drives_) {
    const std::size_t k = first_not_before(drive, time_s);
    if (k < drive.end && calibration_.poses[k].time_s == time_s &&
        calibration_.poses[k].position == position)
      return calibration_.poses[k];
    near.push_back(k);
  }
  for (std::size_t drive = 0; drive < drives_.size(); ++drive)
    if (auto found = interpolated(drives_[drive], near[drive], time_s, position)) return found;
  return std::nullopt;
}

/// `near`: the first scan of the drive that is not before `time_s`. Its neighbours are examined
/// too: two intervals share a scan, and a time past the end of an interval can round to its end.
std::optional<PoseCorrection> CorrectionLookup::interpolated(ScanSpan drive, std::size_t near,
                                                             double time_s, Vec3d position) const {
  const std::vector<PoseCorrection>& poses = calibration_.poses;
  const std::size_t first = near < drive.begin + 3 ? drive.begin : near - 3;
  for (std::size_t k = first; k + 1 < drive.end && k <= near; ++k) {
    const PoseCorrection& a = poses[k];
    const PoseCorrection& b = poses[k + 1];
    const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
    const double min_share = k == drive.begin ? -1.0 : 0.0;
    const double max_share = k + 2 == drive.end ? 2.0 : 1.0;
    if (share < min_share || share > max_share || !passes_close(a, b, share, position)) continue;
    PoseCorrection found = between(poses, k, k + 1, time_s, calibration_.smooth_s, poses.size());
    found.time_s = time_s;
    found.position = position;
    return found;
  }
  return std::nullopt;
}

std::optional<RigidTransform> CorrectionLookup::corrected(const TimedPose& given) const {
  const auto correction = at(given.time_s, given.world_from_sensor.translation);
  if (!correction) return std::nullopt;
  const MountCorrection& mount = calibration_.mount;
  const RigidTransform by_pose = correction->corrected_from_given() * given.world_from_sensor;
  return mount.empty() ? by_pose : by_pose * mount.given_from_mounted();
}

double best_smoothing(const Calibration& calibration) {
  // For white noise the variance of the error is 1.5 with the mean of two neighbours and 1 with the
  // mean of many: a ratio of 0.67. A few scans do not suffice to measure the ratio.
  constexpr double kMaxRatio = 0.8;
  constexpr std::size_t kMinScans = 10;
  const std::vector<PoseCorrection>& poses = calibration.poses;
  const double apart_s = median_step_s(poses);
  const std::vector<double> of_neighbours = left_out_squares(poses, 0);
  if (!(apart_s > 0) || of_neighbours.size() < kMinScans) return 0;
  double best_s = 0, smallest = std::numeric_limits<double>::infinity();
  for (double scans = 1; scans < 2 * static_cast<double>(poses.size()); scans *= 2) {
    const double sum = sum_of(left_out_squares(poses, scans * apart_s));
    if (!(sum < smallest)) continue;
    smallest = sum;
    best_s = scans * apart_s;
  }
  return smallest < kMaxRatio * sum_of(of_neighbours) ? best_s : 0;
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
  const CorrectionLookup lookup(calibration);
  Trajectory corrected = poses;
  for (TimedPose& pose : corrected) {
    const auto corrected_pose = lookup.corrected(pose);
    if (!corrected_pose) return false;
    pose.world_from_sensor = *corrected_pose;
  }
  poses = std::move(corrected);
  return true;
}

std::vector<const Calibration*> calibrations_of_scans(const Calibration& calibration,
                                                      std::span<const CloudSensor> sensors,
                                                      std::size_t scans) {
  if (sensors.empty()) return std::vector<const Calibration*>(scans, &calibration);
  std::vector<const Calibration*> of_scans;
  for (const CloudSensor& sensor : sensors) {
    const Calibration* own = calibration.of_sensor(sensor.name);
    if (own == nullptr) throw std::logic_error("calibrations_of_scans: a sensor without one");
    of_scans.insert(of_scans.end(), sensor.scans, own);
  }
  return of_scans;
}

std::optional<Trajectory> corrected_poses(const Trajectory& given,
                                          std::span<const Calibration* const> of_scans) {
  Trajectory corrected;
  for (std::size_t begin = 0, end = 0; begin < given.size(); begin = end) {
    while (end < given.size() && of_scans[end] == of_scans[begin]) ++end;
    Trajectory part(given.begin() + static_cast<std::ptrdiff_t>(begin),
                    given.begin() + static_cast<std::ptrdiff_t>(end));
    if (!apply(*of_scans[begin], part)) return std::nullopt;
    corrected.insert(corrected.end(), part.begin(), part.end());
  }
  return corrected;
}

bool apply(const Calibration& calibration, PointCloud& cloud, const Executor& executor) {
  if (missing_for_calibration(cloud) != nullptr) return false;
  const std::vector<const Calibration*> of_scans =
      calibrations_of_scans(calibration, cloud.sensors, cloud.scan_poses.size());
  const Trajectory given = cloud.scan_poses;
  const auto corrected = corrected_poses(given, of_scans);
  if (!corrected) return false;
  cloud.scan_poses = *corrected;
  const auto local = [&](RigidTransform pose) {
    pose.translation = pose.translation - cloud.origin;
    return pose;
  };
  std::vector<RigidTransform> corrections, mounts;
  std::vector<Vec3d> axes;
  std::vector<Mat3d> frames;  // sensor_from_world
  for (std::size_t scan = 0; scan < given.size(); ++scan) {
    const RigidTransform before = local(given[scan].world_from_sensor);
    RigidTransform mounted = before, mount;
    if (!of_scans[scan]->mount.empty()) {
      const RigidTransform in_sensor = of_scans[scan]->mount.given_from_mounted();
      mounted = before * in_sensor;
      mount = {before.rotation * in_sensor.rotation * before.rotation.transposed(),
               before.rotation * in_sensor.translation};
    }
    corrections.push_back(local(cloud.scan_poses[scan].world_from_sensor) * mounted.inverse());
    mounts.push_back(mount);
    axes.push_back(before.rotation * Vec3d{0, 0, 1});
    frames.push_back(before.rotation.transposed());
  }
  // Each beam turns about the sensor where it fired: the sensor's way during a scan is not turned.
  const auto mounted = [&](std::size_t scan, Vec3d sensor, Vec3d point) {
    if (of_scans[scan]->mount.empty()) return point;
    return sensor + mounts[scan].translation + mounts[scan].rotation * (point - sensor);
  };
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t scan = cloud.scan_indices[i];
      const Vec3d sensor = vec_cast<double>(cloud.sensor_positions[i]);
      const Vec3d measured = vec_cast<double>(cloud.positions[i]);
      const Vec3d direction = frames[scan] * (measured - sensor);
      const LaserOffsets& lasers = of_scans[scan]->lasers;
      const std::uint16_t laser =
          lasers.laser_of(direction, cloud.lasers.empty() ? kNoLaser : cloud.lasers[i]);
      const Vec3d point = lasers.corrected(sensor, measured, axes[scan], laser);
      cloud.positions[i] = vec_cast<float>(corrections[scan] * mounted(scan, sensor, point));
      cloud.sensor_positions[i] =
          vec_cast<float>(corrections[scan] * (sensor + mounts[scan].translation));
    }
  });
  for (EmptyBeam& beam : cloud.empty_beams) {
    const RigidTransform& correction = corrections[beam.scan];
    const Vec3d origin = vec_cast<double>(beam.origin);
    beam.origin = vec_cast<float>(correction * (origin + mounts[beam.scan].translation));
    beam.direction = vec_cast<float>(
        correction.rotation * (mounts[beam.scan].rotation * vec_cast<double>(beam.direction)));
  }
  return true;
}

namespace {

/// Largest distance of poses from those that a calibration was estimated from, at their times.
double distance_m(const std::vector<PoseCorrection>& given, const Trajectory& poses) {
  double largest = 0;
  for (const TimedPose& pose : poses) {
    auto after = std::ranges::lower_bound(given, pose.time_s, {}, &PoseCorrection::time_s);
    if (after == given.end()) --after;
    const PoseCorrection &b = *after, &a = after == given.begin() ? b : *std::prev(after);
    const double step_s = b.time_s - a.time_s;
    const double share = step_s > 0 ? (pose.time_s - a.time_s) / step_s : 0;
    const Vec3d there = a.position + share * (b.position - a.position);
    largest = std::max(largest, length(there - pose.world_from_sensor.translation));
  }
  return largest;
}

/// The calibration of a drive; of one without the name of a sensor: that with the nearest poses.
const Calibration* calibration_of(const Calibration& calibration, const KittiSequence& sequence) {
  if (!sequence.rig_sensor.empty() || calibration.others.empty())
    return calibration.of_sensor(sequence.rig_sensor.empty() ? calibration.sensor
                                                             : sequence.rig_sensor);
  const Calibration* nearest = &calibration;
  for (const Calibration& other : calibration.others)
    if (!other.poses.empty() && !nearest->poses.empty() &&
        distance_m(other.poses, sequence.trajectory) <
            distance_m(nearest->poses, sequence.trajectory))
      nearest = &other;
  return nearest;
}

}  // namespace

bool apply(const Calibration& calibration, KittiSequence& sequence) {
  const Calibration* own = calibration_of(calibration, sequence);
  if (own == nullptr || !apply(*own, sequence.trajectory)) return false;
  sequence.beams.offsets = own->lasers;
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
