// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/jobs/scene/model_scene.h"

namespace adasplats {

// Poses of a sensor without a recording: level, above the ground of a model.

/// Height above the road of the LiDAR on KITTI's car (Geiger et al., "Vision meets Robotics: The
/// KITTI Dataset", 2013, figure 3), typical of a car's roof.
inline constexpr double kRoofHeight_m = 1.73;
/// 36 km/h.
inline constexpr double kTownSpeed_mps = 10;
/// Of most rotating LiDARs.
inline constexpr double kUsualRate_hz = 10;

/// A position in world coordinates.
struct SensorPlace {
  double x_m = 0;
  double y_m = 0;
  std::optional<double> z_m;  ///< of the sensor itself; nothing: above the ground
  double yaw_deg = 0;         ///< from x towards y
};

/// A corner of a path in world coordinates.
struct PathCorner {
  double x_m = 0;
  double y_m = 0;
};

/// How a path is driven.
struct PathDrive {
  double height_m = kRoofHeight_m;
  double speed_mps = kTownSpeed_mps;  ///< more than 0
  double rate_hz = kUsualRate_hz;     ///< poses a second; more than 0
  std::optional<double> spacing_m;    ///< poses so far apart instead; more than 0
};

/// The ground below or above a position.
struct Ground {
  double z_m;         ///< world
  double distance_m;  ///< horizontal, to the nearest hit
};

/// The lowest level surface that enough rays from below hit, within half a metre of the position or
/// else up to 16 m (models have holes below the recording vehicle, larger where it stood); the
/// median height of the hits, beyond 4 m of the nearest third of them. In a building it is the
/// lowest storey, on a bridge the ground below. Nothing if there is no such surface.
std::optional<Ground> find_ground(const ModelScene& scene, double x_m, double y_m,
                                  const Executor& executor);

/// A level pose at each position, 0.1 s apart. Warns if the model has no ground within 1 m of
/// positions. Errors: data (no ground at a position without z).
Trajectory poses_at(const ModelScene& scene, std::span<const SensorPlace> positions,
                    double height_m, const Executor& executor, ProgressSink& progress);

/// Level poses along a polyline from its first corner, with the x axis along the path (turning
/// within a metre of a corner). Warns as poses_at(). Errors: usage (fewer than two different
/// corners, more than ten million poses), data (no ground).
Trajectory poses_on_path(const ModelScene& scene, std::span<const PathCorner> corners,
                         const PathDrive& drive, const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
