// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Changes the local origin of coordinates.
void move_origin(PointCloud& cloud, Vec3d origin);

/// Joins clouds of one origin; `scan_poses` are those of their scans. An attribute that only some
/// clouds have is dropped with a warning. Sensor positions are kept: points without one get
/// OriginKind::none.
PointCloud join_clouds(std::vector<PointCloud>&& clouds, Vec3d origin, Trajectory scan_poses,
                       ProgressSink& progress);

/// Joins the clouds of the sensors of a rig, each with scans numbered from 0.
PointCloud join_sensors(std::vector<PointCloud>&& clouds, std::vector<CloudSensor> sensors,
                        ProgressSink& progress);

}  // namespace adasplats
