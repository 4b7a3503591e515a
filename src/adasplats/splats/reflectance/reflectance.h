// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/scene/scene.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// How the intensity that a sensor measures depends on range and incidence: intensity =
/// reflectance * range gain * incidence gain. Both are tables, linear between their nodes and
/// constant outside; 1 at about 10 m and head on. Empty tables: 1 everywhere.
struct IntensityResponse {
  std::vector<float> ranges_m;         ///< ascending
  std::vector<float> range_gains;      ///< one a range
  std::vector<float> cos_incidences;   ///< ascending, 0..1
  std::vector<float> incidence_gains;  ///< one a cosine

  bool empty() const { return ranges_m.empty(); }
  float gain(float range_m, float cos_incidence) const;
};

/// Reflectances of splats with the response of the sensor that measured them.
struct Reflectances {
  std::vector<float> values;  ///< one a disk; 0 or more
  IntensityResponse response;
};

/// Casts every measured ray of `cloud` (points with sensor positions and intensities) into its
/// model, and finds by turns the reflectance of every disk and the response of the sensor that
/// explain the intensities of the rays whose first hit lies within 0.2 m (0.5 % of the range more)
/// of the measured point: least squares by turns, five of them. A disk that few rays met is drawn
/// to the disks that face alike in the same 0.4 m cell (as if three rays had said so), that one to
/// the mean of all. The same bytes for any number of threads. `fallback`: values for disks in cells
/// that no ray met, one a disk; NaN: the mean of all. Memory: up to 50 bytes a ray. Without sensor
/// beams, or with fewer than 1000 rays that meet their point: `fallback` and an empty response.
Reflectances measure_reflectances(std::span<const Disk> disks, const Tracer& tracer,
                                  const PointCloud& cloud, Vec3d model_origin,
                                  std::span<const float> fallback, const Executor& executor);

}  // namespace adasplats
