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

/// Points used for the calibration.
struct ChosenPoints {
  std::vector<std::uint32_t> indices;  ///< into the cloud
  std::vector<std::uint32_t> scans;    ///< one per point
  /// Every n-th of the first points is held out for validation.
  std::uint32_t left_out_every = 1, left_out_end = 0;

  bool is_left_out(std::size_t k) const { return k < left_out_end && k % left_out_every == 0; }
};

/// Current estimates.
struct ScanCorrections {
  std::vector<RigidTransform> corrected_from_given;  ///< one per scan, local coordinates
  std::vector<Vec3d> pivots;                         ///< corrected sensor position of each scan
  LaserOffsets offsets;
};

/// Options of the sums over the distances of points from planes.
struct RowOptions {
  std::size_t max_points = 400;  ///< used per plane
  double max_weight = 200;       ///< of a plane, in points
  double width_m = 0;            ///< of the robust weight
  // Estimated unknowns.
  bool poses = true, ranges = true, elevations = true, azimuths = false;
};

/// Sum of the bounded distances of held-out points from one plane.
struct DistanceSum {
  double distance_m = 0, weight = 0;
};

/// The steps of calibrate() over points and planes. Results are bit-identical on all devices.
class CalibrationSteps {
 public:
  enum class PointSet : std::uint8_t { few, all };

  virtual ~CalibrationSteps() = default;
  /// All arguments must outlive the steps. `axes`: rotation axis of the sensor, upwards, one per
  /// scan. `lasers`: their number.
  virtual void load(const PointCloud& cloud, const ChosenPoints& few, const ChosenPoints& all,
                    const std::vector<Vec3d>& axes, std::size_t lasers) = 0;
  /// Applies the corrections to the points.
  virtual void correct(PointSet set, const ScanCorrections& corrections) = 0;
  /// Planes of the points as last corrected, each a range in an order of the points.
  virtual std::vector<ScanPlane> find_planes(PointSet set, const ScanPlaneOptions& options) = 0;

  // The following functions use the planes found last and their points.

  /// Distances of the held-out points from the planes through the others.
  virtual std::vector<double> left_out_residuals() = 0;
  /// Sums of these distances, one per plane, with normals fitted to the current points. Distances
  /// are bounded by `max_m`, the weight of a plane by `max_weight` points.
  virtual std::vector<DistanceSum> left_out_distances(double max_m, double max_weight) = 0;
  /// Chooses the points for sum_rows().
  virtual void choose_rows(const RowOptions& options) = 0;
  /// Normal equations of poses and lasers, linearised at these corrections.
  virtual PlaneBlocks sum_rows(const ScanCorrections& corrections, const RowOptions& options) = 0;
  /// Product with the blocks that couple scans and lasers, as PlaneProduct.
  virtual PlaneStep coupled(const PlaneStep& x) = 0;
};

/// The executor must outlive the steps.
std::unique_ptr<CalibrationSteps> make_cpu_calibration_steps(const Executor& executor);

}  // namespace adasplats
