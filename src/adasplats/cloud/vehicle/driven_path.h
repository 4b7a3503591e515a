// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// The volume that whatever carried the sensor passed through: from above the ground to the sensor,
/// along its path. The numbers are set, not chosen by data: cars are 1.6 m wide and more, robots
/// and people with a scanner half a metre; kerbs and humps are lower than 0.35 m.
struct DrivenPathOptions {
  double half_width_m = 0.6;     ///< of the volume; 0: none
  double above_ground_m = 0.35;  ///< it begins
  double above_sensor_m = 0.1;   ///< it ends
  double step_m = 0.25;          ///< between places of the path
  double max_apart_m = 5;        ///< scans farther apart than this are not joined
  double min_path_m = 5;         ///< shorter ones are no drive
  double ground_radius_m = 1;    ///< points that say where the ground is
  double max_height_m = 3.5;     ///< of the sensor above ground: nothing carries it from there on
  double max_spread_m = 0.5;     ///< of this height between most places, else it is no height
  std::size_t min_points = 20;   ///< that say where the ground is at a place
};

/// Where the sensor was in scans that are not in a cloud which is a piece of a drive, in order,
/// world coordinates.
struct PathBeyond {
  std::vector<Vec3d> before, after;
};

/// The points in the volume that the carrier of the sensor passed through, 1 or 0 each; empty: none
/// or no such volume (origins not measured, a sensor that hardly moved, one in the air, no ground
/// below it), counting only those without a flag in `left_out` (1 or 0 each; empty: all count). The
/// carrier passed `beyond`, too; whether there is such a volume say the scans of the cloud.
/// What was measured there had gone when the carrier passed, or came later: mostly vehicles ahead.
/// Up is +z. Time: two passes over the points.
std::vector<std::uint8_t> find_in_driven_path(const PointCloud& cloud,
                                              const DrivenPathOptions& options,
                                              const Executor& executor,
                                              std::span<const std::uint8_t> left_out = {},
                                              const PathBeyond& beyond = {});

}  // namespace adasplats
