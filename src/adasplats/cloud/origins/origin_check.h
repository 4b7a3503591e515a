// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// No LiDAR that surveys measures farther (RIEGL VZ-6000: 6 km), m.
inline constexpr double kFarthestOriginM = 10e3;

/// Whether a point is hidden by one in the same direction: at more than 1.25 times its range and,
/// for the noise and slant of near surfaces, 0.5 m more.
inline bool lies_behind(float range_m, float nearer_m) { return range_m * 0.8F - 0.5F > nearer_m; }

/// How a cloud looks from one place.
struct StationView {
  std::size_t points = 0;   ///< that were looked at
  double nearest_m = 0;     ///< distance to the nearest point
  double share_behind = 0;  ///< of the points, those that lie behind others, 0..1
  double cell_rad = 0;      ///< of the directions that were compared
};

/// A station sees one surface a direction. Counts the points at more than 1.25 times the range of
/// another one in the same direction (and 0.5 m more), in cells of directions that hold three
/// points on average; of at most 2^20 points, evenly chosen. `from_station`: point minus station,
/// m.
StationView view_from_station(std::span<const Vec3f> from_station, const Executor& executor);

/// Largest StationView::share_behind of points that were measured from there. Single scans of an
/// HDL-64E have 0.025 to 0.056 (edges, leaves; nine places of KITTI and SemanticKITTI); this is
/// twice as much. The same scans joined over 65 m of a drive have 0.27, and four stations of a
/// terrestrial scanner 0.15 to 0.27 from most places. A wrong place only metres off can stay below.
inline constexpr double kMaxBehind = 0.1;
/// Views of fewer points are too coarse to decide.
inline constexpr std::size_t kMinView = 1000;

/// What makes it impossible that all points were measured from there; empty: nothing.
std::string station_objection(const StationView& view);

/// How a cloud looks from the places that a sensor on the move is said to have measured it from.
struct PathView {
  std::size_t places = 0;   ///< that were looked from
  std::size_t points = 0;   ///< measured there, that were looked at
  double share_behind = 0;  ///< of these, those that lie behind other points of the cloud, 0..1
};

/// Looks from sixteen of the origins at what was measured within half a metre of each. A point lies
/// behind others at more than 1.25 times the range of the third nearest one in its direction (and
/// 0.5 m more), in cells of 0.5 degrees; of at most 2^20 points, evenly chosen, up to 100 m away.
/// `positions`, `origins`: of points with beams, one each.
PathView view_from_path(std::span<const Vec3f> positions, std::span<const Vec3f> origins,
                        const Executor& executor);

/// Largest PathView::share_behind of points that were measured from there. Nine drives of KITTI and
/// SemanticKITTI have 0.014 to 0.075 (traffic and leaves), the measuring street 0.008; this is
/// twice as much. The street with its origins turned by 90 degrees has 0.3, a drive of 70 m 0.7, a
/// drive shifted by 10 m 0.06 to 0.25: a wrong path only metres off, or a short one, can stay
/// below.
inline constexpr double kMaxBehindOfPath = 0.15;

/// What makes it impossible that all points were measured from there; empty: nothing.
std::string path_objection(const PathView& view);

}  // namespace adasplats
