// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct PresenceOptions {
  double within_m = 0.1;     ///< from the point, along the ray that measured it
  double min_range_m = 2.5;  ///< points outside these ranges are left out
  double max_range_m = 50;
};

/// Measured points, and how many of them a model has a surface at.
struct Presence {
  std::size_t points = 0;
  std::size_t present = 0;

  /// 0..1; NaN without points.
  double share() const;
};

struct PresenceResult {
  Presence all;
  Presence moving;  ///< classes that move; empty without labels
  Presence still;   ///< other classes
  std::vector<std::pair<std::string, Presence>> by_class;  ///< with labels; by id
};

/// At which measured points does a model have a surface? The ray that measured a point must hit the
/// model within `within_m` of it. Finds missing surfaces (still points without) and wrong ones
/// (moving points with a surface). `labels`: scheme of the classes, or null. Errors: usage
/// (distances that are not positive, an empty range); data (no sensor positions, no points within
/// the ranges, a class that `labels` does not have).
PresenceResult presence(const Tracer& tracer, Vec3d scene_origin, const PointCloud& cloud,
                        const LabelScheme* labels, const PresenceOptions& options,
                        const Executor& executor);

}  // namespace adasplats
