// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "adasplats/calibrate/plane_system.h"
#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Points that are looked at.
struct ChosenPoints {
  std::vector<std::uint32_t> indices;  ///< into the cloud
  std::vector<std::uint32_t> scans;    ///< theirs
  /// Every so many-th takes no part in the fit, to judge it; 0: all take part.
  std::uint32_t left_out_every = 0;

  bool is_left_out(std::size_t k) const { return left_out_every != 0 && k % left_out_every == 0; }
};

/// What is estimated so far.
struct ScanCorrections {
  std::vector<RigidTransform> corrected_from_given;  ///< one a scan, local coordinates
  std::vector<Vec3d> pivots;                         ///< where the sensor of each is with it
  LaserOffsets offsets;
};

/// How the distances of points from planes become sums.
struct RowOptions {
  std::size_t max_points = 400;                         ///< of a plane that are looked at
  double max_weight = 200;                              ///< of a plane, in points
  double width_m = 0;                                   ///< of the residuals that count
  bool poses = true, ranges = true, elevations = true;  ///< what is unknown
};

/// Distances of points that were left out from one plane, each at most so far.
struct DistanceSum {
  double distance_m = 0, weight = 0;
};

/// The steps of calibrate() over points and planes, on some device. Each has the same bits on all.
class CalibrationSteps {
 public:
  enum class PointSet : std::uint8_t { few, all };

  virtual ~CalibrationSteps() = default;
  /// All of it has to outlive the steps. `axes`: of the sensor's rotation, one a scan, upwards.
  /// `lasers`: how many there are.
  virtual void load(const PointCloud& cloud, const ChosenPoints& few, const ChosenPoints& all,
                    const std::vector<Vec3d>& axes, std::size_t lasers) = 0;
  /// Puts points where they are with these corrections.
  virtual void correct(PointSet set, const ScanCorrections& corrections) = 0;
  /// Of points as they were corrected last; with what begins and ends where in an order of them.
  virtual std::vector<ScanPlane> find_planes(PointSet set, const ScanPlaneOptions& options) = 0;

  /// The next are of the planes that were found last, and of their points.

  /// Distances of the points that were left out from planes through the others.
  virtual std::vector<double> left_out_residuals() = 0;
  /// The same as sums, one a plane, with the planes' directions as the points are now. Distances
  /// count as at most `max_m`, planes as at most `max_weight` points.
  virtual std::vector<DistanceSum> left_out_distances(double max_m, double max_weight) = 0;
  /// Chooses the points that sum_rows() looks at.
  virtual void choose_rows(const RowOptions& options) = 0;
  /// What they say of poses and lasers near these corrections.
  virtual PlaneBlocks sum_rows(const ScanCorrections& corrections, const RowOptions& options) = 0;
  /// Of the sums: what couples each scan and laser with the others, as PlaneProduct.
  virtual PlaneStep coupled(const PlaneStep& x) = 0;
};

/// The executor must outlive the steps.
std::unique_ptr<CalibrationSteps> make_cpu_calibration_steps(const Executor& executor);

}  // namespace adasplats
