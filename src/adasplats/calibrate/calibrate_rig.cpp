// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibrate_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "adasplats/calibrate/thin_to_map.h"
#include "adasplats/cloud/load/join_clouds.h"
#include "adasplats/cloud/points/beam_cells.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

/// Map scans this long before and after a window can still see its surfaces.
constexpr double kMapMargin_s = 10;
/// Shares of a cell's own evidence that pull it to no offset (angles) and to the mean of all cells
/// (range). Development values: chosen on PandaSet 002.
constexpr double kCellAngleShare = 0.01, kCellRangeShare = 0.1;

/// Points of scans [begin, end), thinned to about `points_a_scan` per scan.
PointCloud points_of_scans(const PointCloud& cloud, ScanSpan scans, std::size_t points_a_scan) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.scan_indices[i] >= scans.begin && cloud.scan_indices[i] < scans.end)
      chosen.push_back(static_cast<std::uint32_t>(i));
  const std::size_t stride = std::max<std::size_t>(
      1, chosen.size() / (points_a_scan * std::max<std::size_t>(1, scans.size())));
  PointCloud part;
  part.origin = cloud.origin;
  for (std::size_t k = 0; k < chosen.size(); k += stride) {
    const std::uint32_t i = chosen[k];
    part.positions.push_back(cloud.positions[i]);
    part.sensor_positions.push_back(cloud.sensor_positions[i]);
    if (!cloud.origin_kinds.empty()) part.origin_kinds.push_back(cloud.origin_kinds[i]);
    if (!cloud.lasers.empty()) part.lasers.push_back(cloud.lasers[i]);
    part.scan_indices.push_back(cloud.scan_indices[i] - static_cast<std::uint32_t>(scans.begin));
  }
  part.scan_poses.assign(std::next(cloud.scan_poses.begin(), std::ptrdiff_t(scans.begin)),
                         std::next(cloud.scan_poses.begin(), std::ptrdiff_t(scans.end)));
  return part;
}

/// Gives points without lasers the cells of their directions as lasers.
BeamCells assign_cells(PointCloud& cloud) {
  const bool has_lasers =
      std::ranges::any_of(cloud.lasers, [](std::uint16_t laser) { return laser != kNoLaser; });
  if (has_lasers) return {};
  std::vector<Mat3d> sensor_from_world;
  for (const TimedPose& pose : cloud.scan_poses)
    sensor_from_world.push_back(pose.world_from_sensor.rotation.transposed());
  std::vector<Vec3d> directions;
  directions.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    directions.push_back(sensor_from_world[cloud.scan_indices[i]] *
                         vec_cast<double>(cloud.positions[i] - cloud.sensor_positions[i]));
  const BeamCells cells = cover_beams(directions);
  cloud.lasers.clear();
  for (const Vec3d direction : directions) cloud.lasers.push_back(cells.of(direction));
  return cells;
}

std::size_t number_of_lasers(const PointCloud& cloud) {
  std::size_t count = 0;
  for (const std::uint16_t laser : cloud.lasers)
    if (laser != kNoLaser) count = std::max(count, std::size_t{laser} + 1);
  return count;
}

/// Applies pose corrections, one per scan, to the points and poses of a cloud.
void move_scans(PointCloud& cloud, const std::vector<RigidTransform>& world_corrections) {
  std::vector<RigidTransform> local;
  for (std::size_t scan = 0; scan < cloud.scan_poses.size(); ++scan) {
    RigidTransform& pose = cloud.scan_poses[scan].world_from_sensor;
    RigidTransform before = pose;
    before.translation = before.translation - cloud.origin;
    pose = world_corrections[scan] * pose;
    RigidTransform after = pose;
    after.translation = after.translation - cloud.origin;
    local.push_back(after * before.inverse());
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const RigidTransform& correction = local[cloud.scan_indices[i]];
    cloud.positions[i] = vec_cast<float>(correction * vec_cast<double>(cloud.positions[i]));
    cloud.sensor_positions[i] =
        vec_cast<float>(correction * vec_cast<double>(cloud.sensor_positions[i]));
  }
}

/// The correction of the car at a time, from those of its first sensor; the nearest one beyond its
/// ends.
RigidTransform car_correction(const std::vector<PoseCorrection>& poses, double time_s) {
  if (poses.empty()) return {};
  const auto after = std::ranges::lower_bound(poses, time_s, {}, &PoseCorrection::time_s);
  if (after == poses.begin()) return poses.front().corrected_from_given();
  if (after == poses.end()) return poses.back().corrected_from_given();
  const PoseCorrection &a = *std::prev(after), &b = *after;
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  return moved_about(a.position + share * (b.position - a.position),
                     a.rotation_rad + share * (b.rotation_rad - a.rotation_rad),
                     a.shift_m + share * (b.shift_m - a.shift_m));
}

/// Points of the map within the time of a window, as scans behind those of `window`.
PointCloud with_map(const PointCloud& window, const PointCloud& map) {
  double first_s = window.scan_poses.front().time_s, last_s = first_s;
  for (const TimedPose& pose : window.scan_poses) {
    first_s = std::min(first_s, pose.time_s);
    last_s = std::max(last_s, pose.time_s);
  }
  const auto is_near = [&](std::uint32_t scan) {
    const double time_s = map.scan_poses[scan].time_s;
    return time_s >= first_s - kMapMargin_s && time_s <= last_s + kMapMargin_s;
  };
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (is_near(map.scan_indices[i])) chosen.push_back(static_cast<std::uint32_t>(i));
  PointCloud near = gather(map, chosen);
  move_origin(near, window.origin);
  const auto scans = static_cast<std::uint32_t>(window.scan_poses.size());
  for (std::uint32_t& scan : near.scan_indices) scan += scans;
  near.lasers.assign(near.size(), kNoLaser);
  near.origin_kinds.clear();
  PointCloud whole = window;
  if (!whole.origin_kinds.empty()) near.origin_kinds.assign(near.size(), OriginKind::measured);
  if (whole.lasers.empty()) near.lasers.clear();
  append(whole, std::move(near));
  return whole;
}

/// The sensors of a rig, calibrated one after another.
class RigCalibrator {
 public:
  RigCalibrator(const PointCloud& cloud, const CalibrateOptions& options,
                const CalibrateWindowOptions& windows, const CalibrateCloud& calibrate_cloud,
                const Executor& executor, ProgressSink& progress)
      : cloud_(cloud),
        options_(options),
        windows_(windows),
        calibrate_cloud_(calibrate_cloud),
        executor_(executor),
        progress_(progress) {}

  std::pair<Calibration, CalibrationReport> run() {
    for (const CloudSensor& sensor : cloud_.sensors) require_known_motion(sensor);
    std::size_t begin = 0;
    for (const CloudSensor& sensor : cloud_.sensors) {
      PointCloud part =
          points_of_scans(cloud_, {begin, begin + sensor.scans}, options_.points_a_scan);
      begin += sensor.scans;
      if (&sensor == &cloud_.sensors.front())
        add_first(sensor, std::move(part));
      else
        add_other(sensor, std::move(part));
    }
    return {std::move(calibration_), std::move(report_)};
  }

 private:
  void add_first(const CloudSensor& sensor, PointCloud part) {
    std::tie(calibration_, report_) =
        calibrate_drives(part, options_, windows_, calibrate_cloud_, executor_, progress_);
    calibration_.sensor = report_.sensor = sensor.name;
    if (calibration_.poses.empty()) calibration_.poses = unchanged(part.scan_poses);
    apply(calibration_, part, executor_);
    add_to_map(std::move(part));
  }

  void add_other(const CloudSensor& sensor, PointCloud part) {
    const Trajectory given = part.scan_poses;
    std::vector<RigidTransform> by_car;
    for (const TimedPose& pose : given)
      by_car.push_back(car_correction(calibration_.poses, pose.time_s));
    move_scans(part, by_car);
    PointCloud with_given_lasers = part;
    const MapAlignment start = align(sensor, part);
    const BeamCells cells = assign_cells(part);
    with_given_lasers.lasers = part.lasers;
    CalibrateOptions own = options_;
    own.mount_correction = false;
    own.free_scans = part.scan_poses.size();
    own.azimuths = own.elevations && !cells.empty();
    if (!cells.empty()) {
      own.elevation_share = kCellAngleShare;
      own.range_mean_share = kCellRangeShare;
    }
    const CalibrateCloud against_map = [&](const PointCloud& window,
                                           const CalibrateOptions& of_window) {
      CalibrateOptions with = of_window;
      with.free_scans = window.scan_poses.size();
      return calibrate_cloud_(with_map(window, map_), with);
    };
    auto [fine, report] = calibrate_drives(thinned_to_map(part, map_), own, windows_, against_map,
                                           executor_, progress_);
    if (fine.poses.empty()) fine.poses = unchanged(part.scan_poses);
    fine.lasers.cells = cells;
    const Calibration relative = fine;
    apply(relative, part, executor_);
    fine.lasers.range_m.resize(number_of_lasers(part));
    fine.lasers.elevation_rad.resize(fine.lasers.range_m.size());
    if (!fine.lasers.azimuth_rad.empty())
      fine.lasers.azimuth_rad.resize(fine.lasers.range_m.size());
    for (double& range_m : fine.lasers.range_m) range_m += start.range_m;
    const MapAlignment aligned = refined(fine.lasers, start, std::move(with_given_lasers));
    fine.mount = aligned.mount;
    fine.poses = corrections_between(given, part.scan_poses, aligned.mount);
    fine.smooth_s = best_smoothing(fine);
    fine.sensor = report.sensor = sensor.name;
    report.aligned = aligned;
    calibration_.others.push_back(std::move(fine));
    report_.others.push_back(std::move(report));
    add_to_map(std::move(part));
  }

  /// Moves the scans of a sensor to the map.
  MapAlignment align(const CloudSensor& sensor, PointCloud& part) {
    progress_.begin_step("align " + sensor.name, 0);
    MapAlignmentOptions expected;
    if (!options_.ranges) expected.range_m = 0;
    const MapAlignment found = align_with_map(part, map_, expected, executor_);
    progress_.end_step();
    if (!found.fits(expected)) throw misfit(sensor, found);
    apply(found, part);
    return found;
  }

  /// Mount and clock of a sensor with calibrated lasers; its scans move with the car.
  MapAlignment refined(const LaserOffsets& lasers, MapAlignment start, PointCloud part) const {
    Calibration of_lasers;
    of_lasers.lasers = lasers;
    apply(of_lasers, part, executor_);
    MapAlignmentOptions expected;
    expected.range_m = 0;
    const double range_m = std::exchange(start.range_m, 0);  // part of the offsets
    MapAlignment found = refine_alignment(part, map_, start, expected, executor_);
    found.range_m = range_m;
    return found;
  }

  /// The times of points within a scan are part of the clock, and their motion of the mount.
  void require_known_motion(const CloudSensor& sensor) const {
    constexpr double kStill_m = 0.02;
    if (cloud_.sensors.size() < 2 || !(sensor.unknown_sweep_m > kStill_m)) return;
    std::array<char, 500> text{};
    std::snprintf(text.data(), text.size(),
                  "sensor '%s': points at 10 m move by %.2f m within a scan, and nothing shows "
                  "whether this motion is in them (no times, or these fit neither way), so "
                  "mounts and clocks would be wrong; check the frame of the points; use a format "
                  "with point times (PLY, PCD, LAS, "
                  "MCAP, packets), or, if the scans are motion-compensated, state sweep_points = "
                  "\"compensated\" for this sensor in the rig file",
                  sensor.name.c_str(), sensor.unknown_sweep_m);
    throw Error(ErrorKind::data, text.data());
  }

  Error misfit(const CloudSensor& sensor, const MapAlignment& found) const {
    std::array<char, 400> text{};
    std::snprintf(
        text.data(), text.size(),
        "sensor '%s': its points do not fit those of '%s' with any mount within about 5 "
        "degrees and 0.5 m and any clock within 50 ms of the given ones (%.0f %% are near "
        "their surfaces as given); check its input, its mount (degrees, not radians) and "
        "its time offset, or choose another sensor (`topic`)",
        sensor.name.c_str(), cloud_.sensors.front().name.c_str(), 100 * found.given_share);
    return {ErrorKind::data, text.data()};
  }

  static std::vector<PoseCorrection> unchanged(const Trajectory& given) {
    return corrections_between(given, given);
  }

  /// The corrections of poses that remain with a mount.
  static std::vector<PoseCorrection> corrections_between(const Trajectory& given,
                                                         const Trajectory& corrected,
                                                         const MountCorrection& mount = {}) {
    std::vector<PoseCorrection> poses;
    for (std::size_t scan = 0; scan < given.size(); ++scan) {
      const RigidTransform& from = given[scan].world_from_sensor;
      const RigidTransform mounted = from * mount.given_from_mounted();
      const RigidTransform correction = corrected[scan].world_from_sensor * mounted.inverse();
      poses.push_back({given[scan].time_s, from.translation, rotation_vector(correction.rotation),
                       correction * from.translation - from.translation});
    }
    return poses;
  }

  void add_to_map(PointCloud part) {
    part.lasers = {};
    part.origin_kinds = {};
    const auto scans = static_cast<std::uint32_t>(map_.scan_poses.size());
    for (std::uint32_t& scan : part.scan_indices) scan += scans;
    append(map_, std::move(part));
  }

  const PointCloud& cloud_;
  const CalibrateOptions& options_;
  const CalibrateWindowOptions& windows_;
  const CalibrateCloud& calibrate_cloud_;
  const Executor& executor_;
  ProgressSink& progress_;
  PointCloud map_;  ///< corrected points of the sensors so far
  Calibration calibration_;
  CalibrationReport report_;
};

}  // namespace

std::pair<Calibration, CalibrationReport> calibrate_rig(
    const PointCloud& cloud, const CalibrateOptions& options, const CalibrateWindowOptions& windows,
    const CalibrateCloud& calibrate_cloud, const Executor& executor, ProgressSink& progress) {
  return RigCalibrator(cloud, options, windows, calibrate_cloud, executor, progress).run();
}

}  // namespace adasplats
