// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/plane_system.h"
#include "adasplats/calibrate/trajectory_fit.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

constexpr std::size_t kLeftOut = 8;  // every eighth point is held out
constexpr double kValidationFlatness_m = 0.1;
constexpr double kFixed = 1e12;          // weight that keeps a pose
constexpr double kMaxDistance_m = 0.25;  // of a point in the comparison of mounts

double between(double first, double last, int round, int rounds) {
  const double share = rounds > 1 ? static_cast<double>(round) / (rounds - 1) : 1;
  return first * std::pow(last / first, share);
}

ResidualCounts counts_of(const std::vector<double>& residuals_m) {
  ResidualCounts result;
  for (const double residual_m : residuals_m) {
    const auto bin = static_cast<std::size_t>(residual_m / ResidualCounts::kBin_m);
    ++result.counts[std::min(bin, result.counts.size() - 1)];
  }
  return result;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return upper_median_of(values);
}

class Calibrator {
 public:
  using PointSet = CalibrationSteps::PointSet;

  Calibrator(const PointCloud& cloud, const CalibrateOptions& options, CalibrationSteps& steps,
             const Executor& executor)
      : cloud_(cloud), options_(options), steps_(steps), executor_(executor) {
    for (const TimedPose& pose : cloud.scan_poses) {
      const RigidTransform& world_from_sensor = pose.world_from_sensor;
      positions_.push_back(world_from_sensor.translation - cloud.origin);
      axes_.push_back(world_from_sensor.rotation * Vec3d{0, 0, 1});
    }
    for (const std::uint16_t laser : cloud.lasers)
      if (laser != kNoLaser) lasers_ = std::max(lasers_, std::size_t{laser} + 1);
    mounted_from_given_.resize(positions_.size());
    corrected_from_mounted_.resize(positions_.size());
    corrections_.offsets.range_m.resize(lasers_);
    corrections_.offsets.elevation_rad.resize(lasers_);
    corrections_.offsets.azimuth_rad.resize(lasers_);
    free_ = std::min(options.free_scans, positions_.size());
    compose();
    choose_points();
    steps_.load(cloud_, few_, all_, axes_, lasers_);
  }

  std::pair<Calibration, CalibrationReport> run() {
    CalibrationReport report;
    validate(report.given_m, report.given);
    if (options_.mount_correction) report.mount = estimate_mount();
    const bool is_mounted = report.mount && report.mount->objection.empty();
    double before_m = report.given_m;
    if (is_mounted) validate(before_m, report.calibrated);
    if (!options_.poses && !options_.ranges && !options_.elevations && !options_.azimuths)
      report.objection = is_mounted || !report.mount ? "nothing else was asked for"
                                                     : "the mount: " + report.mount->objection;
    for (int round = 0; round < options_.rounds && report.objection.empty(); ++round)
      make_round(round, report);
    if (report.objection.empty()) {
      align_to_mounted();
      validate(report.calibrated_m, report.calibrated);
      if (!(report.calibrated_m < options_.min_gain * before_m))
        report.objection = "points that took no part lie no better on the planes of the others";
    }
    if (report.objection.empty()) return {calibration(), report};
    if (!is_mounted) return {{}, report};
    keep_mount_alone(report);
    return {calibration(), report};
  }

 private:
  void make_round(int round, CalibrationReport& report) {
    const PointSet points =
        round + options_.fine_rounds < options_.rounds ? PointSet::few : PointSet::all;
    const std::vector<ScanPlane> planes = find_planes(
        points,
        between(options_.first_flatness_m, options_.last_flatness_m, round, options_.rounds));
    report.planes = planes.size();
    report.points = 0;
    for (const ScanPlane& plane : planes) report.points += plane.end - plane.begin;
    report.weakest_share = weakest_share(planes, report.weakest);
    report.objection = objection_to(report);
    if (!report.objection.empty()) return;
    RowOptions rows{options_.max_points,
                    options_.max_weight,
                    between(options_.first_width_m, options_.last_width_m, round, options_.rounds),
                    options_.poses,
                    options_.ranges,
                    options_.elevations,
                    options_.azimuths};
    steps_.choose_rows(rows);
    for (int step = 0; step < options_.steps; ++step) make_step(rows);
  }

  void keep_mount_alone(CalibrationReport& report) {
    std::ranges::fill(corrected_from_mounted_, RigidTransform{});
    corrections_.offsets = {};
    corrections_.offsets.range_m.resize(lasers_);
    corrections_.offsets.elevation_rad.resize(lasers_);
    corrections_.offsets.azimuth_rad.resize(lasers_);
    compose();
    validate(report.calibrated_m, report.calibrated);
    corrections_.offsets = {};
    report.mount->alone_because = std::move(report.objection);
    report.objection.clear();
  }

  /// Chooses every n-th point that belongs to a beam, with n from points_a_scan, and a subset for
  /// coarse rounds.
  void choose_points() {
    const std::size_t wanted = options_.points_a_scan * std::max<std::size_t>(1, positions_.size());
    const std::size_t stride = std::max<std::size_t>(1, cloud_.size() / wanted);
    const std::size_t candidates = (cloud_.size() + stride - 1) / stride;
    const auto for_beams = [&](const auto& take) {
      executor_.for_chunks(candidates, kCoarseGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          if (is_beam(cloud_.origin_kind(k * stride))) take(begin / kCoarseGrain, k * stride);
      });
    };
    std::vector<std::size_t> next(candidates / kCoarseGrain + 1);
    for_beams([&](std::size_t chunk, std::size_t) { ++next[chunk]; });
    std::size_t count = 0;
    for (std::size_t& of_chunk : next) count += std::exchange(of_chunk, count);
    all_.indices.resize(count);
    all_.scans.resize(count);
    for_beams([&](std::size_t chunk, std::size_t i) {
      all_.indices[next[chunk]] = static_cast<std::uint32_t>(i);
      all_.scans[next[chunk]++] = cloud_.scan_indices[i];
    });
    all_.left_out_every = kLeftOut;
    const auto of_map = std::ranges::find_if(all_.scans, [&](auto scan) { return scan >= free_; });
    all_.left_out_end = static_cast<std::uint32_t>(of_map - all_.scans.begin());
    for (std::size_t k = 0; k < count; k += options_.coarse_stride) {
      if (all_.is_left_out(k)) continue;
      few_.indices.push_back(all_.indices[k]);
      few_.scans.push_back(all_.scans[k]);
    }
  }

  /// Combines the mount with the corrections of scans.
  void compose() {
    corrections_.corrected_from_given.resize(positions_.size());
    corrections_.pivots.resize(positions_.size());
    for (std::size_t scan = 0; scan < positions_.size(); ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      corrections_.corrected_from_given[scan] = correction * mounted_from_given_[scan];
      corrections_.pivots[scan] = correction * positions_[scan];
    }
  }

  /// Every `stride`-th chosen point that is not held out, in the frame of its scan.
  MountPoints mount_points(std::size_t stride) const {
    std::vector<RigidTransform> sensor_from_local;
    for (const TimedPose& pose : cloud_.scan_poses) {
      RigidTransform local_from_sensor = pose.world_from_sensor;
      local_from_sensor.translation = local_from_sensor.translation - cloud_.origin;
      sensor_from_local.push_back(local_from_sensor.inverse());
    }
    MountPoints points;
    for (std::size_t k = 0; k < all_.indices.size(); k += stride) {
      if (all_.is_left_out(k)) continue;
      points.in_sensor.push_back(sensor_from_local[all_.scans[k]] *
                                 vec_cast<double>(cloud_.positions[all_.indices[k]]));
      points.scans.push_back(all_.scans[k]);
    }
    return points;
  }

  /// Searches with few points; refines errors that corrections of single poses cannot compensate.
  MountReport estimate_mount() {
    const MountOptions& mount = options_.mount;
    const std::size_t wanted = mount.points_a_scan * std::max<std::size_t>(1, positions_.size());
    // Odd: the points of a laser can be a power of two apart.
    const std::size_t stride = std::max<std::size_t>(1, all_.indices.size() / wanted) | 1;
    MountReport report;
    if (positions_.size() < mount.min_scans) {
      report.objection = "too few scans (" + std::to_string(positions_.size()) + ")";
      return report;
    }
    report.found = search_mount(mount_points(stride), cloud_.scan_poses, mount, executor_);
    report.objection = objection_to(report.found);
    if (!report.objection.empty()) return report;
    report.found = refine_mount(mount_points(1), cloud_.scan_poses, report.found, mount, executor_);
    report.objection = objection_to(report.found);
    if (!report.objection.empty()) return report;
    compare_mounts(report);
    if (report.mounted_m < mount.min_gain * report.given_m) return report;
    report.objection =
        "points that took no part lie not clearly better on the planes of the others";
    set_mount({});
    return report;
  }

  /// Compares both mounts on the planes that are flat with the given one and on those that are flat
  /// with the found one. Sets the mount.
  void compare_mounts(MountReport& report) {
    DistanceSum given, mounted;
    find_planes(PointSet::all, kValidationFlatness_m);
    add_left_out(given);
    set_mount(report.found.mount);
    steps_.correct(PointSet::all, corrections_);
    add_left_out(mounted);
    find_planes(PointSet::all, kValidationFlatness_m);
    add_left_out(mounted);
    set_mount({});
    steps_.correct(PointSet::all, corrections_);
    add_left_out(given);
    set_mount(report.found.mount);
    const auto mean_m = [](const DistanceSum& sum) {
      return sum.weight > 0 ? sum.distance_m / sum.weight : 0;
    };
    report.given_m = mean_m(given);
    report.mounted_m = mean_m(mounted);
  }

  /// Adds the distances of held-out points from planes through the others of the same cells.
  void add_left_out(DistanceSum& sum) {
    for (const DistanceSum& of_plane :
         steps_.left_out_distances(kMaxDistance_m, options_.max_weight)) {
      sum.distance_m += of_plane.distance_m;
      sum.weight += of_plane.weight;
    }
  }

  std::string objection_to(const MountEstimate& found) const {
    const MountOptions& mount = options_.mount;
    if (found.planes < mount.min_planes)
      return "too few planes that several scans saw (" + std::to_string(found.planes) + ")";
    if (length(found.mount.rotation_rad) < mount.min_rotation_rad &&
        length(found.mount.shift_m) < mount.min_shift_m)
      return "what is wrong with it is no more than corrections of single poses make up for";
    if (!(found.deviations >= mount.min_deviations)) return "it is not clear from the data";
    return {};
  }

  void set_mount(const MountCorrection& mount) {
    mount_ = mount;
    const RigidTransform given_from_mounted = mount.given_from_mounted();
    for (std::size_t scan = 0; scan < positions_.size(); ++scan) {
      RigidTransform given = cloud_.scan_poses[scan].world_from_sensor;
      given.translation = given.translation - cloud_.origin;
      const RigidTransform mounted = given * given_from_mounted;
      positions_[scan] = mounted.translation;
      mounted_from_given_[scan] = mount.empty() ? RigidTransform{} : mounted * given.inverse();
    }
    compose();
  }

  /// Planes of the points with the current corrections.
  std::vector<ScanPlane> find_planes(PointSet points, double flatness_m) {
    ScanPlaneOptions planes = options_.planes;
    planes.flatness_m = flatness_m;
    steps_.correct(points, corrections_);
    return steps_.find_planes(points, planes);
  }

  void add_priors(PlaneSystem& system, bool has_lasers) const {
    const auto weight = [&](double sigma) {
      return std::pow(options_.residual_sigma_m / sigma, 2);
    };
    for (std::size_t scan = free_; scan < positions_.size(); ++scan)
      for (std::size_t unknown = 0; unknown < 6; ++unknown)
        system.add_pose_prior(scan, unknown, kFixed, 0);
    for (std::size_t scan = 0; scan < free_; ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      const Vec3d turned = rotation_vector(correction.rotation);
      const Vec3d position = positions_[scan];
      const Vec3d shifted = correction * position - position;
      for (int axis = 0; axis < 3; ++axis) {
        const auto unknown = static_cast<std::size_t>(axis);
        system.add_pose_prior(scan, unknown, weight(options_.rotation_sigma_rad), -turned[axis]);
        system.add_pose_prior(scan, unknown + 3, weight(options_.translation_sigma_m),
                              -shifted[axis]);
      }
    }
    const LaserOffsets& offsets = corrections_.offsets;
    for (std::size_t laser = 0; has_lasers && laser < lasers_; ++laser) {
      system.add_laser_prior(laser, 0, weight(options_.range_sigma_m), options_.range_share,
                             -offsets.range_m[laser]);
      system.add_laser_prior(laser, 1, weight(options_.elevation_sigma_rad),
                             options_.elevation_share, -offsets.elevation_rad[laser]);
      system.add_laser_prior(laser, 2, weight(options_.elevation_sigma_rad),
                             options_.elevation_share, -offsets.azimuth_rad[laser]);
    }
    if (has_lasers && options_.range_mean_share > 0)
      system.pull_ranges_to_mean(options_.range_mean_share, offsets.range_m);
  }

  void make_step(const RowOptions& rows) {
    PlaneBlocks blocks = steps_.sum_rows(corrections_, rows);
    const bool has_lasers = !blocks.lasers.empty();
    PlaneSystem system(std::move(blocks));
    add_priors(system, has_lasers);
    apply(system.solve(options_.tolerance, options_.max_iterations,
                       [&](const PlaneStep& x) { return steps_.coupled(x); }));
  }

  void apply(const PlaneStep& step) {
    for (std::size_t scan = 0; options_.poses && scan < free_; ++scan) {
      RigidTransform& correction = corrected_from_mounted_[scan];
      const Vec3d pivot = correction * positions_[scan];
      const double* const x = step.poses.data() + 6 * scan;
      correction = moved_about(pivot, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}) * correction;
    }
    LaserOffsets& offsets = corrections_.offsets;
    if (options_.ranges) add_step(offsets.range_m, step.lasers, 0, has_map());
    if (options_.elevations) add_step(offsets.elevation_rad, step.lasers, 1, false);
    if (options_.azimuths) add_step(offsets.azimuth_rad, step.lasers, 2, false);
    compose();
  }

  /// Share of the planes' weight along the direction in which they constrain the poses least.
  double weakest_share(const std::vector<ScanPlane>& planes, Vec3d& direction) const {
    SymmetricMat3d normals;
    double total = 0;
    for (const ScanPlane& plane : planes) {
      const double weight = std::min(options_.max_weight, double(plane.end - plane.begin));
      const Vec3d n = plane.normal;
      total += weight;
      normals.xx += weight * n.x * n.x;
      normals.xy += weight * n.x * n.y;
      normals.xz += weight * n.x * n.z;
      normals.yy += weight * n.y * n.y;
      normals.yz += weight * n.y * n.z;
      normals.zz += weight * n.z * n.z;
    }
    const SymmetricEigen eigen = symmetric_eigen(normals);
    direction = eigen.vectors[2];
    return total > 0 ? std::max(0.0, eigen.values[2]) / total : 0;
  }

  std::string objection_to(const CalibrationReport& report) const {
    if (report.planes < options_.min_planes)
      return "too few planes that several scans saw (" + std::to_string(report.planes) + ")";
    if (report.weakest_share < options_.min_share) {
      std::array<char, 128> text{};
      std::snprintf(text.data(), text.size(),
                    "no planes hold the poses along (%.2f, %.2f, %.2f), as in a straight tunnel",
                    report.weakest.x, report.weakest.y, report.weakest.z);
      return text.data();
    }
    return {};
  }

  /// Removes the mean unless it is observed: a common offset does not calibrate lasers against
  /// each other.
  static void add_step(std::vector<double>& offsets, const std::vector<double>& steps,
                       std::size_t which, bool keeps_mean) {
    for (std::size_t k = 0; k < offsets.size(); ++k)
      offsets[k] += steps[kLaserUnknowns * k + which];
    const double mean = keeps_mean ? 0 : mean_of(offsets);
    for (double& offset : offsets) offset -= mean;
  }

  static double mean_of(const std::vector<double>& values) {
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    return mean;
  }

  bool has_map() const { return free_ < positions_.size(); }

  /// Aligns all poses to the given ones, with the mount corrected, by one rigid motion.
  void align_to_mounted() {
    if (has_map()) return;
    std::vector<PoseCorrection> poses;
    for (std::size_t scan = 0; scan < positions_.size(); ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      poses.push_back({cloud_.scan_poses[scan].time_s, positions_[scan],
                       rotation_vector(correction.rotation),
                       correction * positions_[scan] - positions_[scan]});
    }
    const RigidTransform back = onto_given(poses);
    for (RigidTransform& correction : corrected_from_mounted_) correction = back * correction;
    compose();
  }

  /// Measures the distances of held-out points from the planes through the others.
  void validate(double& median_m, ResidualCounts& counts) {
    find_planes(PointSet::all, kValidationFlatness_m);
    std::vector<double> residuals_m = steps_.left_out_residuals();
    counts = counts_of(residuals_m);
    median_m = median(std::move(residuals_m));
  }

  Calibration calibration() const {
    Calibration result;
    result.mount = mount_;
    for (std::size_t scan = 0; scan < free_; ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      const TimedPose& given = cloud_.scan_poses[scan];
      const Vec3d position = given.world_from_sensor.translation - cloud_.origin;
      result.poses.push_back({given.time_s, given.world_from_sensor.translation,
                              rotation_vector(correction.rotation),
                              correction * position - position});
    }
    result.lasers = corrections_.offsets;
    result.smooth_s = best_smoothing(result);
    return result;
  }

  const PointCloud& cloud_;
  const CalibrateOptions& options_;
  CalibrationSteps& steps_;
  const Executor& executor_;
  // One a scan, in local coordinates:
  std::vector<Vec3d> positions_;  ///< of the sensor with the corrected mount
  std::vector<Vec3d> axes_;       ///< of the sensor's rotation, upwards
  std::vector<RigidTransform> mounted_from_given_;
  std::vector<RigidTransform> corrected_from_mounted_;
  std::size_t lasers_ = 0, free_ = 0;  ///< numbers of lasers and of scans without the map
  ChosenPoints all_;                   ///< for the last rounds and for validation
  ChosenPoints few_;                   ///< for the rounds before
  MountCorrection mount_;
  ScanCorrections corrections_;  ///< of mount, scans and lasers
};

}  // namespace

std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    const Executor& executor) {
  return calibrate(cloud, options, *make_cpu_calibration_steps(executor), executor);
}

std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    CalibrationSteps& steps,
                                                    const Executor& executor) {
  if (const char* missing = missing_for_calibration(cloud)) return {{}, {.objection = missing}};
  return Calibrator(cloud, options, steps, executor).run();
}

}  // namespace adasplats
