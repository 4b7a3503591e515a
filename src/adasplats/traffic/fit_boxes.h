// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/traffic/track_clusters.h"

namespace adasplats {

struct BoxFitOptions {
  double min_speed_mps = 1;  ///< slower tracks do not move; slower motion has no direction
  double min_way_m = 1.2;    ///< between the ends of a track that moves
  double face_m = 0.15;      ///< standard deviation of a visible face
  double acceleration = 2;   ///< m/s^2, of the motion over one second
};

/// Boxes around the clusters of a track, one per cluster; nothing if it does not move. x points
/// where it drives. Only the faces that the sensor sees are measured: the middle is half a length
/// behind the nearest one. The size is that of the largest clusters, or that of a usual
/// object of its kind where no side was seen whole. The kind, by size and speed, is the label:
/// "car", "truck", "cyclist" or "pedestrian". `height_below`: of the ground below a point, NaN if
/// unknown.
std::optional<BoxTrack> fit_boxes(const ClusterTrack& track, std::span<const LoosePoints> loose,
                                  FunctionRef<double(Vec3d)> height_below,
                                  const BoxFitOptions& options);

/// The box around an object at rest from its points in many scans: the turn with the smallest area,
/// x along the longer side. A side of a vehicle that was not seen whole gets the usual length, away
/// from the sensors. World coordinates, m; at least one point. `label`: as of object_kind_of().
TimedBox fit_box_at_rest(std::span<const Vec3d> points, std::span<const Vec3d> sensors,
                         std::string_view label);

}  // namespace adasplats
