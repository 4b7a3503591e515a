// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/jobs/scene/model_scene.h"

namespace adasplats {

// Poses of a sensor without any recording of one: places in a model, level, above its ground.

/// Of the LiDAR of KITTI's car above the road (Geiger et al., "Vision meets Robotics: The KITTI
/// Dataset", 2013, figure 3), which is about that of any mounted on a car's roof.
inline constexpr double kRoofHeight_m = 1.73;
/// 36 km/h.
inline constexpr double kTownSpeed_mps = 10;
/// Of most LiDARs that turn.
inline constexpr double kUsualRate_hz = 10;

/// A place in world coordinates.
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

/// World height of the ground below or above a place, m: the lowest level thing that most of the
/// model's beams from below meet around it, within half a metre or else up to 4 m (where the
/// vehicle itself stood, models have holes); the median of what they meet. Of a place with several
/// storeys that is the lowest one, of a bridge what is below it. Nothing where there is none.
std::optional<double> ground_height(const ModelScene& scene, double x_m, double y_m,
                                    const Executor& executor);

/// A pose at each place, level, 0.1 s apart. Errors: data (no ground at a place without a height).
Trajectory poses_at(const ModelScene& scene, std::span<const SensorPlace> places, double height_m,
                    const Executor& executor);

/// Poses along straight lines between corners, from the first corner on, level, the x axis along
/// the path (turning within a metre of a corner). Errors: usage (fewer than two corners, no length,
/// more than ten million poses), data (no ground).
Trajectory poses_on_path(const ModelScene& scene, std::span<const PathCorner> corners,
                         const PathDrive& drive, const Executor& executor);

}  // namespace adasplats
