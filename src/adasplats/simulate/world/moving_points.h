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
  /// Of every splat, m: the average distance between points of moving objects (paper section
  /// "SimKITTI32").
  double radius_m = 0.14;
  /// Points that a normal is fitted to, the point itself among them.
  std::uint32_t neighbors = 10;
  /// None of them is farther than this, m: points of one class without instances may be two
  /// objects.
  double reach_m = 0.5;
  /// Of the sensor that measured the scan: intensities become reflectances, as those of a model
  /// with a response are. None: they stay as measured.
  const IntensityResponse* response = nullptr;
};

/// Splats of what moves during one scan.
struct MovingSplats {
  SplatModel splats;  ///< sensor frame; with classes, and intensities as far as the scan has them
  std::vector<std::uint16_t> instances;  ///< one a splat
};

/// One splat for every point of a class that moves (Mobility::moving), in the order of the scan, as
/// paper section "SimKITTI32" makes moving objects: in the place they would leave trails, so each
/// scan has its own (WorldObject::only_scan, with the scan's pose). The normal is that of the plane
/// through the nearest points of the same class and instance, on the sensor's side; where these are
/// fewer than three or on one line, the splat faces the sensor. Points that are not finite, or at
/// the sensor itself, are left out. A scan without labels has no moving points.
/// Errors: usage (a radius or reach that is not positive).
MovingSplats moving_splats(const KittiScan& scan, const LabelScheme& scheme,
                           const MovingSplatOptions& options, const Executor& executor);

}  // namespace adasplats
