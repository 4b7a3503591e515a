// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

struct MovingSplatOptions {
  /// Radius of every splat, m: the average distance between points of moving objects (paper section
  /// "SimKITTI32").
  double radius_m = 0.14;
  /// Number of points used to fit a normal, including the point itself.
  std::uint32_t neighbors = 10;
  /// Their maximum distance, m: points of one class without instances may belong to two objects.
  double reach_m = 0.5;
  /// Of the sensor that measured the scan: intensities become reflectances, as those of a model
  /// with a response are. None: they stay as measured.
  const IntensityResponse* response = nullptr;
};

/// Splats of the moving objects of one scan.
struct MovingSplats {
  SplatModel splats;  ///< sensor frame; with classes, and intensities if the scan has them
  std::vector<std::uint16_t> instances;  ///< one per splat
};

/// Makes one splat for every point of a moving class (Mobility::moving), in the order of the scan,
/// as in the paper's section "SimKITTI32": moving objects would leave trails in the scene, so each
/// scan has its own (WorldObject::only_scan, with the scan's pose). The normal is that of the plane
/// through the nearest points of the same class and instance, oriented towards the sensor; with
/// fewer than three or collinear points, the splat faces the sensor. Points that are not finite or
/// at the sensor are skipped. A scan without labels has no moving points. Errors: usage (a radius
/// or reach that is not positive).
MovingSplats moving_splats(const KittiScan& scan, const LabelScheme& scheme,
                           const MovingSplatOptions& options, const Executor& executor);

}  // namespace adasplats
