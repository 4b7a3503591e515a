// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// How points lie on the cones of a sensor, and the mount near a given one that they lie on best.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/sensor_cones.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Nearer points are the vehicle's own; farther ones are few, and wind and poses move them more.
inline constexpr double kNearestOnCones_m = 3;
inline constexpr double kFarthestOnCones_m = 80;
/// Points of the later stages, by which a laser of 128 has twenty and a hundred and fifty.
inline constexpr std::size_t kBetterPoints = 3000;
inline constexpr std::size_t kFinalPoints = 20000;

/// Where a point lies among the cones.
struct ConePlace {
  std::size_t laser;
  double residual_rad;  ///< positive: above the cone
  double gap_rad;       ///< to the next cone on that side; of an outer one: to its neighbour
  bool outside;         ///< beyond the outer cones by more than half that gap
};

/// Cones and the gaps between them.
class ConeTable {
 public:
  explicit ConeTable(const SensorCones& cones) : cones_(&cones) {
    for (std::size_t i = 0; i + 1 < cones.cones.size(); ++i)
      gaps_rad_.push_back(cones.cones[i].elevation_rad - cones.cones[i + 1].elevation_rad);
    for (const SensorCones::Cone& cone : cones.cones)
      mean_height_m_ += cone.height_m / static_cast<double>(cones.cones.size());
  }

  const SensorCones& sensor() const { return *cones_; }
  std::size_t size() const { return cones_->cones.size(); }
  const SensorCones::Cone& operator[](std::size_t laser) const { return cones_->cones[laser]; }
  double mean_height_m() const { return mean_height_m_; }
  double gap_above(std::size_t laser) const { return gaps_rad_[laser == 0 ? 0 : laser - 1]; }
  double gap_below(std::size_t laser) const {
    return gaps_rad_[std::min(laser, gaps_rad_.size() - 1)];
  }

  ConePlace place_of(Vec3d point) const {
    const auto [laser, residual_rad] = cones_->nearest(point);
    const bool above = residual_rad > 0;
    const double gap_rad = above ? gap_above(laser) : gap_below(laser);
    const bool outer = above ? laser == 0 : laser + 1U == size();
    return {laser, residual_rad, gap_rad, outer && std::abs(residual_rad) > 0.5 * gap_rad};
  }

 private:
  const SensorCones* cones_;
  std::vector<double> gaps_rad_;
  double mean_height_m_ = 0;
};

/// One of each of `count` equal parts of the points, at random: a stride could meet the same laser
/// again and again where points come in the order of firing.
std::vector<Vec3d> sample_of(std::span<const Vec3d> points, std::size_t count);

/// How well points lie on the cones of a table, seen from a mount. Shares are of the points where
/// nothing else is said.
struct ConeScore {
  double residual_rad = 0;
  double chance_rad = 0;
  double share = 0;    ///< near their cones
  double outside = 0;  ///< beyond the table
  double largest = 0;  ///< of the laser that has most
  double filled = 0;   ///< share of the table's lasers that have points
  double empty = 0;    ///< share of lasers without points, from the first to the last that has some

  double ratio() const { return chance_rad > 0 ? residual_rad / chance_rad : 1; }
};

ConeScore score_of(std::span<const Vec3d> points, const ConeTable& table,
                   const RigidTransform& mount);

/// A mount without a turn about the vertical.
RigidTransform mount_of(Vec3d origin, double roll_rad, double pitch_rad);

/// The sensor's axis, in the vehicle's frame.
Vec3d axis_of(const RigidTransform& mount);

/// How far a mount may be off.
struct MountDoubt {
  double tilt_rad;
  double height_m;
  double aside_m;  ///< in the plane

  friend MountDoubt operator*(double scale, MountDoubt d) {
    return {scale * d.tilt_rad, scale * d.height_m, scale * d.aside_m};
  }
};

/// Of a mount that is nearly right.
inline constexpr MountDoubt kFound = {0.1 * kDegree, 0.03, 0.06};

/// How much of a shift in the plane a point's elevation shows, against one in height.
double slope_of(Vec3d p);
/// What a doubt makes of the elevation of a point in the sensor's frame, rad.
double angle_of(const MountDoubt& doubt, Vec3d p);

/// Steps of Gauss-Newton while the doubt falls to what the angles of sensors and the poses of
/// drives leave.
RigidTransform refined_mount(std::span<const Vec3d> points, const ConeTable& table,
                             MountDoubt doubt, int steps, RigidTransform mount);

/// A mount and how the points lie on the cones from there.
struct ConeFit {
  RigidTransform mount;
  ConeScore score;
};

/// From a mount that is nearly right.
ConeFit fit_near(std::span<const Vec3d> points, const ConeTable& table,
                 const RigidTransform& mount);

/// The mounts that are searched.
inline constexpr double kMaxAside_m = 2;
inline constexpr double kLowest_m = -0.5;
inline constexpr double kHighest_m = 2.5;
inline constexpr double kMaxTilt_rad = 1.25 * kDegree;

/// The best mount of one sensor: a grid of places and tilts, judged by the points that lead
/// farthest (far ones, sparse lasers), then Gauss-Newton from the best of them with more and more
/// points.
ConeFit searched_fit(std::span<const Vec3d> points, const ConeTable& table,
                     const Executor& executor);

}  // namespace adasplats
