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

#include "adasplats/calibrate/plane_system.h"
#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/core/maths/small_motion.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

constexpr std::size_t kLeftOut = 8;         // every so many-th point
constexpr double kFlatnessOfJudging = 0.1;  // m
constexpr double kMostDistance_m = 0.25;    // that counts where mounts are compared

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
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct DistanceSum {
  double distance_m = 0, weight = 0;

  DistanceSum& operator+=(const DistanceSum& other) {
    distance_m += other.distance_m;
    weight += other.weight;
    return *this;
  }
};

/// Points that are looked at, as indices into the cloud.
struct ChosenPoints {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> scans;  ///< theirs
  std::vector<Vec3d> corrected;
  bool leaves_out = false;  ///< some take no part in the fit, to judge it

  bool is_left_out(std::size_t k) const { return leaves_out && k % kLeftOut == 0; }
  void add(std::uint32_t index, std::uint32_t scan) {
    indices.push_back(index);
    scans.push_back(scan);
  }
};

/// The ray of a point, in local coordinates.
struct PointRay {
  Vec3d direction, upward;
  double range_m = 0;
};

class Calibrator {
 public:
  Calibrator(const PointCloud& cloud, const CalibrateOptions& options, const Executor& executor)
      : cloud_(cloud), options_(options), executor_(executor) {
    for (const TimedPose& pose : cloud.scan_poses) {
      const RigidTransform& world_from_sensor = pose.world_from_sensor;
      places_.push_back(world_from_sensor.translation - cloud.origin);
      axes_.push_back(world_from_sensor.rotation * Vec3d{0, 0, 1});
    }
    for (const std::uint16_t laser : cloud.lasers)
      if (laser != kNoLaser) lasers_ = std::max(lasers_, std::size_t{laser} + 1);
    mounted_from_given_.resize(places_.size());
    corrected_from_mounted_.resize(places_.size());
    offsets_.range_m.resize(lasers_);
    offsets_.elevation_rad.resize(lasers_);
    choose_points();
  }

  std::pair<Calibration, CalibrationReport> run() {
    CalibrationReport report;
    correct(all_);
    judge(report.given_m, report.given);
    if (options_.mount_correction) report.mount = estimate_mount();
    const bool is_mounted = report.mount && report.mount->objection.empty();
    double before_m = report.given_m;
    if (is_mounted) judge(before_m, report.calibrated);
    if (!options_.poses && !options_.ranges && !options_.elevations)
      report.objection = is_mounted || !report.mount ? "nothing else was asked for"
                                                     : "the mount: " + report.mount->objection;
    for (int round = 0; round < options_.rounds && report.objection.empty(); ++round)
      make_round(round, report);
    if (report.objection.empty()) {
      align_to_mounted();
      correct(all_);
      judge(report.calibrated_m, report.calibrated);
      if (!(report.calibrated_m < options_.least_gain * before_m))
        report.objection = "points that took no part lie no better on the planes of the others";
    }
    if (report.objection.empty()) return {calibration(), report};
    if (!is_mounted) return {{}, report};
    keep_mount_alone(report);
    return {calibration(), report};
  }

 private:
  void make_round(int round, CalibrationReport& report) {
    ChosenPoints& points = round + options_.fine_rounds < options_.rounds ? few_ : all_;
    correct(points);
    const ScanPlanes planes = find_planes(
        points,
        between(options_.first_flatness_m, options_.last_flatness_m, round, options_.rounds));
    report.planes = planes.planes.size();
    report.points = planes.points.size();
    report.weakest_share = weakest_share(planes, report.weakest);
    report.objection = objection_to(report);
    const double width_m =
        between(options_.first_width_m, options_.last_width_m, round, options_.rounds);
    for (int step = 0; step < options_.steps && report.objection.empty(); ++step) {
      make_step(points, planes, width_m);
      correct(points);
    }
  }

  void keep_mount_alone(CalibrationReport& report) {
    std::ranges::fill(corrected_from_mounted_, RigidTransform{});
    offsets_ = {};
    correct(all_);
    judge(report.calibrated_m, report.calibrated);
    report.mount->alone_because = std::move(report.objection);
    report.objection.clear();
  }

  /// Every so many-th point with a known beam, so that the scans have as many as are wanted in the
  /// mean, and few of these.
  void choose_points() {
    const std::size_t wanted = options_.points_a_scan * std::max<std::size_t>(1, places_.size());
    const std::size_t stride = std::max<std::size_t>(1, cloud_.size() / wanted);
    for (std::size_t i = 0; i < cloud_.size(); i += stride) {
      if (!is_beam(cloud_.origin_kind(i))) continue;
      all_.add(static_cast<std::uint32_t>(i), cloud_.scan_indices[i]);
    }
    all_.leaves_out = true;
    for (std::size_t k = 0; k < all_.indices.size(); k += options_.coarse_stride)
      if (!all_.is_left_out(k)) few_.add(all_.indices[k], all_.scans[k]);
  }

  std::uint16_t laser_of(std::uint32_t i) const {
    return cloud_.lasers.empty() ? kNoLaser : cloud_.lasers[i];
  }

  PointRay ray_of(std::uint32_t i) const {
    PointRay ray;
    const Vec3d way =
        vec_cast<double>(cloud_.positions[i]) - vec_cast<double>(cloud_.sensor_positions[i]);
    ray.range_m = length(way);
    if (!(ray.range_m > 0)) return ray;
    ray.direction = way / ray.range_m;
    ray.upward = upward_of(ray.direction, axes_[cloud_.scan_indices[i]]);
    return ray;
  }

  void correct(ChosenPoints& points) const {
    points.corrected.resize(points.indices.size());
    executor_.for_chunks(points.indices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) points.corrected[k] = corrected(points.indices[k]);
    });
  }

  Vec3d corrected(std::uint32_t i) const {
    const std::uint32_t scan = cloud_.scan_indices[i];
    return corrected_from_mounted_[scan] *
           (mounted_from_given_[scan] *
            offsets_.corrected(vec_cast<double>(cloud_.sensor_positions[i]),
                               vec_cast<double>(cloud_.positions[i]), axes_[scan], laser_of(i)));
  }

  /// Every `stride`-th of the chosen points that are not left out, in the frames of their scans.
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

  /// Searches with few points; what poses of single scans do not make up for is looked at closely.
  MountReport estimate_mount() {
    const MountOptions& mount = options_.mount;
    const std::size_t wanted = mount.points_a_scan * std::max<std::size_t>(1, places_.size());
    // Odd: points of a laser may lie a power of two apart.
    const std::size_t stride = std::max<std::size_t>(1, all_.indices.size() / wanted) | 1;
    MountReport report;
    if (places_.size() < mount.least_scans) {
      report.objection = "too few scans (" + std::to_string(places_.size()) + ")";
      return report;
    }
    report.found = search_mount(mount_points(stride), cloud_.scan_poses, mount, executor_);
    report.objection = objection_to(report.found);
    if (!report.objection.empty()) return report;
    report.found = refine_mount(mount_points(1), cloud_.scan_poses, report.found, mount, executor_);
    report.objection = objection_to(report.found);
    if (!report.objection.empty()) return report;
    judge_mount(report);
    if (report.mounted_m < mount.least_gain * report.given_m) return report;
    report.objection =
        "points that took no part lie not clearly better on the planes of the others";
    set_mount({});
    return report;
  }

  /// Of the planes that are flat with the given mount, and of those that are with the found one:
  /// the floor is flat with any, so it is the same points that are compared. Sets the mount.
  void judge_mount(MountReport& report) {
    const std::vector<Vec3d> given = all_.corrected;
    const ScanPlanes of_given = find_planes(all_, kFlatnessOfJudging);
    set_mount(report.found.mount);
    const ScanPlanes of_mounted = find_planes(all_, kFlatnessOfJudging);
    const auto mean_m = [&](const std::vector<Vec3d>& points) {
      DistanceSum sum = left_out_distances(points, of_given);
      sum += left_out_distances(points, of_mounted);
      return sum.weight > 0 ? sum.distance_m / sum.weight : 0;
    };
    report.given_m = mean_m(given);
    report.mounted_m = mean_m(all_.corrected);
  }

  /// Of points that were left out from planes through the others of the same cells.
  DistanceSum left_out_distances(const std::vector<Vec3d>& points, const ScanPlanes& planes) const {
    return executor_.sum_chunks(
        planes.planes.size(), 256, DistanceSum{}, [&](std::size_t begin, std::size_t end) {
          DistanceSum sum;
          for (std::size_t plane = begin; plane < end; ++plane)
            sum += left_out_distance(points, planes.points_of(planes.planes[plane]));
          return sum;
        });
  }

  DistanceSum left_out_distance(const std::vector<Vec3d>& points,
                                std::span<const std::uint32_t> members) const {
    Vec3d mean;
    double count = 0;
    for (const std::uint32_t i : members) {
      if (all_.is_left_out(i)) continue;
      mean = mean + points[i];
      ++count;
    }
    if (count < 3) return {};
    mean = mean / count;
    SymmetricMat3d spread;
    for (const std::uint32_t i : members) {
      if (all_.is_left_out(i)) continue;
      const Vec3d d = points[i] - mean;
      spread.xx += d.x * d.x;
      spread.xy += d.x * d.y;
      spread.xz += d.x * d.z;
      spread.yy += d.y * d.y;
      spread.yz += d.y * d.z;
      spread.zz += d.z * d.z;
    }
    const Vec3d normal = symmetric_eigen(spread).vectors[2];
    DistanceSum sum;
    for (const std::uint32_t i : members) {
      if (!all_.is_left_out(i)) continue;
      sum.distance_m += std::min(kMostDistance_m, std::fabs(dot(normal, points[i] - mean)));
      ++sum.weight;
    }
    const double scale = sum.weight > 0 ? std::min(1.0, options_.most_weight / count) : 0;
    return {scale * sum.distance_m, scale * sum.weight};
  }

  std::string objection_to(const MountEstimate& found) const {
    const MountOptions& mount = options_.mount;
    if (found.planes < mount.least_planes)
      return "too few planes that several scans saw (" + std::to_string(found.planes) + ")";
    if (length(found.mount.rotation_rad) < mount.least_rotation_rad &&
        length(found.mount.shift_m) < mount.least_shift_m)
      return "what is wrong with it is no more than corrections of single poses make up for";
    if (!(found.deviations >= mount.least_deviations)) return "it is not clear from the data";
    return {};
  }

  void set_mount(const MountCorrection& mount) {
    mount_ = mount;
    const RigidTransform given_from_mounted = mount.given_from_mounted();
    for (std::size_t scan = 0; scan < places_.size(); ++scan) {
      RigidTransform given = cloud_.scan_poses[scan].world_from_sensor;
      given.translation = given.translation - cloud_.origin;
      const RigidTransform mounted = given * given_from_mounted;
      places_[scan] = mounted.translation;
      mounted_from_given_[scan] = mount.empty() ? RigidTransform{} : mounted * given.inverse();
    }
    correct(all_);
  }

  ScanPlanes find_planes(const ChosenPoints& points, double flatness_m) const {
    ScanPlaneOptions planes = options_.planes;
    planes.flatness_m = flatness_m;
    return find_scan_planes(points.corrected, points.scans, planes, executor_);
  }

  PlaneResidual residual_of(const ChosenPoints& points, std::size_t k,
                            const ScanPlane& plane) const {
    PlaneResidual row;
    const std::uint32_t i = points.indices[k];
    row.scan = points.scans[k];
    const RigidTransform& correction = corrected_from_mounted_[row.scan];
    const Vec3d from_center = points.corrected[k] - plane.center;
    row.residual_m = dot(plane.normal, from_center);
    row.by_plane = {1, dot(plane.axes[0], from_center), dot(plane.axes[1], from_center)};
    const Vec3d arm = points.corrected[k] - correction * places_[row.scan];
    const Vec3d turning = cross(arm, plane.normal);
    if (options_.poses)
      row.by_pose = {turning.x,      turning.y,      turning.z,
                     plane.normal.x, plane.normal.y, plane.normal.z};
    const std::uint16_t laser = laser_of(i);
    if (laser == kNoLaser) return row;
    row.laser = laser;
    const PointRay ray = ray_of(i);
    const Mat3d rotation = correction.rotation * mounted_from_given_[row.scan].rotation;
    if (options_.ranges) row.by_laser[0] = dot(plane.normal, rotation * ray.direction);
    if (options_.elevations)
      row.by_laser[1] = ray.range_m * dot(plane.normal, rotation * ray.upward);
    return row;
  }

  void residuals_of(const ChosenPoints& points, const ScanPlanes& planes, const ScanPlane& plane,
                    double width_m, std::vector<PlaneResidual>& residuals) const {
    const auto members = planes.points_of(plane);
    const std::size_t stride = (members.size() + options_.most_points - 1) / options_.most_points;
    double total = 0;
    for (std::size_t k = 0; k < members.size(); k += stride) {
      if (points.is_left_out(members[k])) continue;
      residuals.push_back(residual_of(points, members[k], plane));
      residuals.back().weight = robust_weight(residuals.back().residual_m, width_m);
      total += residuals.back().weight;
    }
    const double scale = total > options_.most_weight ? options_.most_weight / total : 1;
    for (PlaneResidual& residual : residuals) residual.weight *= scale;
  }

  void add_priors(PlaneSystem& system) const {
    const auto weight = [&](double sigma) {
      return std::pow(options_.residual_sigma_m / sigma, 2);
    };
    for (std::size_t scan = 0; scan < places_.size(); ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      const Vec3d turned = rotation_vector(correction.rotation);
      const Vec3d place = places_[scan];
      const Vec3d shifted = correction * place - place;
      for (int axis = 0; axis < 3; ++axis) {
        const auto unknown = static_cast<std::size_t>(axis);
        system.add_pose_prior(scan, unknown, weight(options_.rotation_sigma_rad), -turned[axis]);
        system.add_pose_prior(scan, unknown + 3, weight(options_.translation_sigma_m),
                              -shifted[axis]);
      }
    }
    for (std::size_t laser = 0; laser < lasers_; ++laser) {
      system.add_laser_prior(laser, 0, weight(options_.range_sigma_m), options_.range_share,
                             -offsets_.range_m[laser]);
      system.add_laser_prior(laser, 1, weight(options_.elevation_sigma_rad),
                             options_.elevation_share, -offsets_.elevation_rad[laser]);
    }
  }

  void make_step(const ChosenPoints& points, const ScanPlanes& planes, double width_m) {
    PlaneSystem system(places_.size(), lasers_, executor_);
    system.add_planes(planes.planes.size(),
                      [&](std::size_t plane, std::vector<PlaneResidual>& residuals) {
                        residuals_of(points, planes, planes.planes[plane], width_m, residuals);
                      });
    add_priors(system);
    apply(system.solve(options_.tolerance, options_.most_iterations));
  }

  void apply(const PlaneSystem::Step& step) {
    for (std::size_t scan = 0; options_.poses && scan < places_.size(); ++scan) {
      RigidTransform& correction = corrected_from_mounted_[scan];
      const Vec3d pivot = correction * places_[scan];
      const auto& x = step.poses[scan];
      correction = moved_about(pivot, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}) * correction;
    }
    if (options_.ranges) add_centred(offsets_.range_m, step.lasers, 0);
    if (options_.elevations) add_centred(offsets_.elevation_rad, step.lasers, 1);
  }

  /// Share of the planes' weight that holds the poses along the direction that it holds least.
  double weakest_share(const ScanPlanes& planes, Vec3d& direction) const {
    SymmetricMat3d normals;
    double total = 0;
    for (const ScanPlane& plane : planes.planes) {
      const double weight = std::min(options_.most_weight, double(plane.end - plane.begin));
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
    if (report.planes < options_.least_planes)
      return "too few planes that several scans saw (" + std::to_string(report.planes) + ")";
    if (report.weakest_share < options_.least_share) {
      std::array<char, 128> text{};
      std::snprintf(text.data(), text.size(),
                    "no planes hold the poses along (%.2f, %.2f, %.2f), as in a straight tunnel",
                    report.weakest.x, report.weakest.y, report.weakest.z);
      return text.data();
    }
    return {};
  }

  /// What all lasers have in common is no calibration of one against the other.
  static void add_centred(std::vector<double>& offsets,
                          const std::vector<PlaneSystem::LaserStep>& steps, std::size_t which) {
    double mean = 0;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      offsets[k] += steps[k][which];
      mean += offsets[k] / static_cast<double>(offsets.size());
    }
    for (double& offset : offsets) offset -= mean;
  }

  /// Turns and shifts the whole so that the poses lie on the given ones, as mounted.
  void align_to_mounted() {
    if (places_.empty()) return;
    const double n = static_cast<double>(places_.size());
    Vec3d turn, given, corrected;
    for (std::size_t scan = 0; scan < places_.size(); ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      turn = turn + rotation_vector(correction.rotation) / n;
      given = given + places_[scan] / n;
      corrected = corrected + (correction * places_[scan]) / n;
    }
    const RigidTransform back = moved_about(corrected, -turn, given - corrected);
    for (RigidTransform& correction : corrected_from_mounted_) correction = back * correction;
  }

  void judge(double& median_m, ResidualCounts& counts) const {
    std::vector<double> residuals_m = left_out_residuals();
    counts = counts_of(residuals_m);
    median_m = median(std::move(residuals_m));
  }

  /// Distances of the points that were left out from the planes of the others.
  std::vector<double> left_out_residuals() const {
    const ScanPlanes found = find_planes(all_, kFlatnessOfJudging);
    std::vector<double> residuals;
    for (const ScanPlane& plane : found.planes) {
      Vec3d mean;
      double count = 0;
      for (const std::uint32_t i : found.points_of(plane)) {
        if (all_.is_left_out(i)) continue;
        mean = mean + all_.corrected[i];
        ++count;
      }
      if (count < 3) continue;
      for (const std::uint32_t i : found.points_of(plane))
        if (all_.is_left_out(i))
          residuals.push_back(std::fabs(dot(plane.normal, all_.corrected[i] - mean / count)));
    }
    return residuals;
  }

  Calibration calibration() const {
    Calibration result;
    result.mount = mount_;
    for (std::size_t scan = 0; scan < places_.size(); ++scan) {
      const RigidTransform& correction = corrected_from_mounted_[scan];
      const TimedPose& given = cloud_.scan_poses[scan];
      const Vec3d place = given.world_from_sensor.translation - cloud_.origin;
      result.poses.push_back({given.time_s, given.world_from_sensor.translation,
                              rotation_vector(correction.rotation), correction * place - place});
    }
    result.lasers = offsets_;
    result.smooth_s = best_smoothing(result);
    return result;
  }

  const PointCloud& cloud_;
  const CalibrateOptions& options_;
  const Executor& executor_;
  std::vector<Vec3d> places_;  ///< of the sensor, one a scan, as mounted, local coordinates
  std::vector<Vec3d> axes_;    ///< of its rotation, upwards
  std::size_t lasers_ = 0;
  ChosenPoints all_;  ///< of the last rounds and of judging
  ChosenPoints few_;  ///< of the rounds before
  MountCorrection mount_;
  std::vector<RigidTransform> mounted_from_given_;      ///< one a scan, local coordinates, and...
  std::vector<RigidTransform> corrected_from_mounted_;  ///< ...what is left to correct
  LaserOffsets offsets_;
};

}  // namespace

std::pair<Calibration, CalibrationReport> calibrate(const PointCloud& cloud,
                                                    const CalibrateOptions& options,
                                                    const Executor& executor) {
  if (const char* missing = missing_for_calibration(cloud)) return {{}, {.objection = missing}};
  return Calibrator(cloud, options, executor).run();
}

}  // namespace adasplats
