// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

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
