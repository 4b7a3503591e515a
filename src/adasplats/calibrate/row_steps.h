// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {

// Steps of the calibration for one point or for the points of one plane. Each writes only the data
// of element `i`, so a parallel loop on any device can run it (for_each of a backend).

/// The rays of a cloud, and the corrections of scans and lasers.
struct RaysView {
  const Vec3f* positions;
  const Vec3f* sensors;
  const std::uint32_t* scan_indices;
  const std::uint16_t* lasers;                 ///< null: unknown
  const Vec3d* axes;                           ///< one per scan
  const RigidTransform* corrected_from_given;  ///< one per scan
  const double* range_m;                       ///< one per laser
  const double* elevation_rad;                 ///< one per laser
  const double* azimuth_rad;                   ///< one per laser
  std::size_t laser_count;

  ADASPLATS_HD std::uint16_t laser_of(std::uint32_t i) const {
    return lasers == nullptr ? kNoLaser : lasers[i];
  }
  ADASPLATS_HD Vec3d corrected(std::uint32_t i) const {
    const std::uint32_t scan = scan_indices[i];
    const std::uint16_t laser = laser_of(i);
    const Vec3d end = vec_cast<double>(positions[i]);
    return corrected_from_given[scan] *
           (laser >= laser_count
                ? end
                : corrected_end(vec_cast<double>(sensors[i]), end, axes[scan], range_m[laser],
                                elevation_rad[laser], azimuth_rad[laser]));
  }
};

struct CorrectPoint {
  RaysView rays;
  const std::uint32_t* indices;
  Vec3d* corrected;

  ADASPLATS_HD void operator()(std::size_t k) const { corrected[k] = rays.corrected(indices[k]); }
};

/// Selects the points of a plane that are used.
struct PlaneMembers {
  const ScanPlane* planes;
  const std::uint32_t* order;
  std::uint32_t left_out_every, left_out_end;

  ADASPLATS_HD bool is_left_out(std::uint32_t k) const {
    return k < left_out_end && k % left_out_every == 0;
  }
  /// Calls take(k) for at most `max_points` points that are not held out.
  template <class Take>
  ADASPLATS_HD void for_some(std::size_t plane, std::size_t max_points, Take&& take) const {
    const std::size_t begin = planes[plane].begin, end = planes[plane].end;
    const std::size_t stride = (end - begin + max_points - 1) / max_points;
    for (std::size_t at = begin; at < end; at += stride)
      if (!is_left_out(order[at])) take(order[at]);
  }
};

struct CountRows {
  static constexpr std::size_t kGrain = 64;

  PlaneMembers members;
  std::size_t max_points;
  std::uint32_t* counts;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    std::uint32_t count = 0;
    members.for_some(plane, max_points, [&](std::uint32_t) { ++count; });
    counts[plane] = count;
  }
};

/// Lists the points and their keys of plane and scan.
struct ListRows {
  static constexpr std::size_t kGrain = 64;

  PlaneMembers members;
  std::size_t max_points;
  const std::uint64_t* begins;
  const std::uint32_t* scans;
  int scan_bits;
  std::uint32_t* points;
  std::uint64_t* keys;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    std::uint64_t row = begins[plane];
    members.for_some(plane, max_points, [&](std::uint32_t k) {
      points[row] = k;
      keys[row] = std::uint64_t{plane} << scan_bits | scans[k];
      ++row;
    });
  }
};

/// Distance of a point from its plane and its derivatives by the unknowns of its laser. `u_m` and
/// `v_m` give the derivatives by the unknowns of its scan and plane.
struct PlaneRow {
  double residual_m;
  double u_m, v_m;  ///< coordinates in the plane
  double weight;    ///< before the weight of the plane is limited
  double by_laser[kLaserUnknowns];
};

struct MeasureRow {
  RaysView rays;
  const std::uint32_t* indices;
  const std::uint32_t* points;
  const std::uint64_t* keys;
  int scan_bits;
  const ScanPlane* planes;
  RowOptions options;
  PlaneRow* rows;

  ADASPLATS_HD void operator()(std::size_t r) const {
    const std::uint32_t i = indices[points[r]];
    const ScanPlane& plane = planes[keys[r] >> scan_bits];
    const Vec3d from_center = rays.corrected(i) - plane.center;
    PlaneRow row{};
    row.residual_m = dot(plane.normal, from_center);
    row.u_m = dot(plane.axes[0], from_center);
    row.v_m = dot(plane.axes[1], from_center);
    row.weight = robust_weight(row.residual_m, options.width_m);
    if (rays.laser_of(i) < rays.laser_count) set_laser(i, plane, row);
    rows[r] = row;
  }

 private:
  ADASPLATS_HD void set_laser(std::uint32_t i, const ScanPlane& plane, PlaneRow& row) const {
    const std::uint32_t scan = rays.scan_indices[i];
    const Vec3d way = vec_cast<double>(rays.positions[i]) - vec_cast<double>(rays.sensors[i]);
    const double range_m = length(way);
    if (!(range_m > 0)) return;
    const Vec3d direction = way / range_m;
    const Mat3d& rotation = rays.corrected_from_given[scan].rotation;
    if (options.ranges) row.by_laser[0] = dot(plane.normal, rotation * direction);
    if (options.elevations)
      row.by_laser[1] =
          range_m * dot(plane.normal, rotation * upward_across(direction, rays.axes[scan]));
    if (options.azimuths)
      row.by_laser[2] =
          range_m * dot(plane.normal, rotation * sideways_across(direction, rays.axes[scan]));
  }
};

/// Counts the held-out points of a plane; 0 if fewer than three other points define the plane.
struct CountLeftOut {
  static constexpr std::size_t kGrain = 64;

  PlaneMembers members;
  std::uint32_t* counts;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    std::uint32_t kept = 0, left_out = 0;
    for (std::uint32_t at = members.planes[plane].begin; at < members.planes[plane].end; ++at)
      ++(members.is_left_out(members.order[at]) ? left_out : kept);
    counts[plane] = kept < 3 ? 0 : left_out;
  }
};

/// Mean of the points of a plane that are not held out.
struct KeptMean {
  Vec3d mean;
  double count = 0;
};

ADASPLATS_HD inline KeptMean kept_mean(const PlaneMembers& members, std::size_t plane,
                                       const Vec3d* positions) {
  KeptMean kept;
  for (std::uint32_t at = members.planes[plane].begin; at < members.planes[plane].end; ++at) {
    const std::uint32_t k = members.order[at];
    if (members.is_left_out(k)) continue;
    kept.mean = kept.mean + positions[k];
    ++kept.count;
  }
  if (kept.count > 0) kept.mean = kept.mean / kept.count;
  return kept;
}

struct MeasureLeftOut {
  static constexpr std::size_t kGrain = 64;

  PlaneMembers members;
  const Vec3d* positions;
  const std::uint64_t* begins;
  double* residuals_m;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    if (begins[plane] == begins[plane + 1]) return;
    const Vec3d mean = kept_mean(members, plane, positions).mean;
    const Vec3d normal = members.planes[plane].normal;
    std::uint64_t to = begins[plane];
    for (std::uint32_t at = members.planes[plane].begin; at < members.planes[plane].end; ++at) {
      const std::uint32_t k = members.order[at];
      if (members.is_left_out(k)) residuals_m[to++] = std::fabs(dot(normal, positions[k] - mean));
    }
  }
};

/// Sums the distances of the held-out points, with the normal fitted to the current points.
struct SumLeftOut {
  static constexpr std::size_t kGrain = 64;

  PlaneMembers members;
  const Vec3d* positions;
  double max_m, max_weight;
  DistanceSum* sums;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    sums[plane] = {};
    const KeptMean kept = kept_mean(members, plane, positions);
    if (kept.count < 3) return;
    const Vec3d normal = normal_about(kept.mean, plane);
    double distance_m = 0, weight = 0;
    for (std::uint32_t at = members.planes[plane].begin; at < members.planes[plane].end; ++at) {
      const std::uint32_t k = members.order[at];
      if (!members.is_left_out(k)) continue;
      const double away_m = std::fabs(dot(normal, positions[k] - kept.mean));
      distance_m += away_m < max_m ? away_m : max_m;
      ++weight;
    }
    const double scale = max_weight < kept.count ? max_weight / kept.count : 1;
    sums[plane] = {scale * distance_m, scale * weight};
  }

 private:
  ADASPLATS_HD Vec3d normal_about(Vec3d mean, std::size_t plane) const {
    SymmetricMat3d spread;
    for (std::uint32_t at = members.planes[plane].begin; at < members.planes[plane].end; ++at) {
      const std::uint32_t k = members.order[at];
      if (members.is_left_out(k)) continue;
      const Vec3d d = positions[k] - mean;
      spread.xx += d.x * d.x;
      spread.xy += d.x * d.y;
      spread.xz += d.x * d.z;
      spread.yy += d.y * d.y;
      spread.yz += d.y * d.z;
      spread.zz += d.z * d.z;
    }
    return symmetric_eigen(spread).vectors[2];
  }
};

}  // namespace adasplats
