// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/cloud/point_cloud.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// How the recording vehicle itself is found among the points. The constants were chosen on one
/// KITTI and eight SemanticKITTI drives, where all that was found is the bonnet (1.1 to 2.6 m from
/// the sensor, 0.5 to 1 m below it) and no ring of the ground came near: of the body's rings 54 to
/// 100 % of the points are unconfirmed, of the ground's up to 36 %.
struct OwnBodyOptions {
  double reach_m = 4;      ///< of a body from its sensor
  double ring_m = 0.1;     ///< width and height of rings around the vertical axis of the sensor
  double cell_m = 0.2;     ///< points of others in a cell or beside it confirm those in it...
  int confirmed_by = 3;    ///< ...from so many stations farther than `reach_m`, as traffic is not
  double station_m = 0.5;  ///< side of the cells of sensor positions that are one station
  std::size_t least_stations = 8;  ///< of fewer nothing can be told
  double least_path_m = 8;         ///< nor where the sensor moved less
  double least_share = 0.3;        ///< of the stations that have points in a ring of the body
  double least_unconfirmed = 0.5;  ///< of its points...
  double most_unconfirmed = 0.3;   ///< ...and of those around it, up to twice `reach_m` away
  std::size_t around = 20'000;     ///< so many of these are looked at, evenly chosen
};

/// The points on the vehicle, mast or person that carried the sensor, 1 or 0 each; empty: none
/// found. They keep their place beside the sensor while it moves, and no other station sees
/// anything where they are. Rings instead of cells in the sensor's frame, since a point tells where
/// its sensor was, but not how it was turned. Only measured origins count. Nothing is found of a
/// sensor at rest, where what stands beside it looks the same, nor where stations do not see each
/// other's surroundings (rooms of a building, profiles of a mobile scanner): there nothing is
/// confirmed that is no body either. Time: a few passes over the points.
std::vector<std::uint8_t> find_own_body(const PointCloud& cloud, const OwnBodyOptions& options,
                                        const Executor& executor);

/// The points nearer to their sensor than `radius_m`, where that is stated or measured.
std::vector<std::uint8_t> points_within(const PointCloud& cloud, double radius_m,
                                        const Executor& executor);

}  // namespace adasplats
