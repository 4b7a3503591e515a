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

/// How the recording vehicle itself is found among the points. Chosen on one KITTI and eight
/// SemanticKITTI drives, where it is the bonnet, 1.1 to 2 m from the sensor and 0.5 to 0.8 m below
/// it: 0.90 to 1 of the beams go through its rings, at most 0.80 through any other.
struct OwnBodyOptions {
  double reach_m = 4;             ///< of a body from its sensor
  double ring_m = 0.1;            ///< width and height of rings around the sensor's vertical axis
  double station_m = 0.2;         ///< side of the cells of sensor positions that are one station
  std::size_t min_stations = 20;  ///< fewer decide nothing
  double min_path_m = 8;          ///< nor where the sensor moved less
  double min_share = 0.1;         ///< of the stations that have points in a ring of the body
  std::size_t looking = 64;       ///< stations that look for it, evenly chosen
  std::size_t looked_at = 256;    ///< points of a ring that they look at, evenly chosen
  double min_view_m = 2;          ///< nearer to a station it may see its own body there
  double margin_m = 0.5;          ///< a beam that ends so far behind a point went through it
  double min_through = 0.85;      ///< of the beams at a ring's points, of those not stopped before
};

/// The points on the vehicle, mast or person that carried the sensor, 1 or 0 each; empty: none
/// found. They keep their place beside the sensor while it moves, and beams from elsewhere go
/// through where they are. Rings instead of cells in the sensor's frame, since a point says where
/// its sensor was, but not how it was turned. Only measured origins count, and points without a
/// flag in `left_out` (1 or 0 each; empty: all). Nothing is found where no other beams know: a
/// sensor at rest, rooms of a building, profiles of a mobile scanner. Time: a few passes over the
/// points.
std::vector<std::uint8_t> find_own_body(const PointCloud& cloud, const OwnBodyOptions& options,
                                        const Executor& executor,
                                        std::span<const std::uint8_t> left_out = {});

/// The points nearer to their sensor than `radius_m`, where that is stated or measured.
std::vector<std::uint8_t> points_within(const PointCloud& cloud, double radius_m,
                                        const Executor& executor);

}  // namespace adasplats
