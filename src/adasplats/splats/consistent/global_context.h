// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/hilbert.h"
#include "adasplats/splats/consistent/seed_disk.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// What a piece of a place has to know of the whole, so that the splats that stand far enough from
/// where it was cut are those of the whole, to the last bit. Coordinates are relative to the origin
/// of the piece's cloud, which must be that of the whole's for that.
struct GlobalContext {
  CurveBox box;            ///< of all points: they are ordered along the same curve
  TypicalSpacing typical;  ///< of all cells
  std::size_t rays = 0;    ///< measured ones of all: they say in how many parts rays are cast
  /// Rays that cross the piece and end elsewhere: ends and sensor positions alone.
  PointCloud passing;
  /// Beams without return that cross the piece, as ends_of() has them; those of the piece's cloud
  /// itself are not looked at.
  PointCloud empty;
  std::optional<IntensityResponse> response;  ///< of the sensor; nothing: by the piece's own rays
};

/// How dense the cells are at one of them.
struct CellSpacing {
  Vec3f place;        ///< mean of its points
  float spacing = 0;  ///< to the 7th nearest cell, in units of spacing_unit_m()
  bool with_beam = false;
};

/// In steps of a two hundredth or less: a few cells more or less, which a piece sees other
/// neighbours of, must not change all disks.
double rounded_spacing(double median);

/// Medians of spacings, rounded; what there is none of is 0. Their order does not matter.
TypicalSpacing typical_spacing(std::vector<float> with_beam, std::vector<float> without);

}  // namespace adasplats
