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

/// Facts about a city that the model of one tile needs. With them, splats far enough from the
/// tile's border are those of a model of the whole city, to the last bit. Coordinates are relative
/// to the origin of the tile's cloud, which must be that of the whole city's cloud.
struct GlobalContext {
  CurveBox box;            ///< of all points, so that all tiles use the same curve
  TypicalSpacing typical;  ///< of all cells
  std::size_t rays = 0;    ///< measured rays of all: decides in how many parts rays are cast
  /// Rays that cross the tile and end outside it: only ends and sensor positions.
  PointCloud passing;
  /// Beams without return that cross the tile, from ends_of(). They replace those of the tile's
  /// cloud.
  PointCloud empty;
  std::optional<IntensityResponse> response;  ///< of the sensor; nullopt: fitted to the tile's rays
};

/// Distance of a cell to its neighbours.
struct CellSpacing {
  Vec3f place;        ///< mean of its points
  float spacing = 0;  ///< to the 7th nearest cell, in units of spacing_unit_m()
  bool with_beam = false;
  bool flat = false;     ///< needs no smaller cells (FlagNotFlat)
  bool limited = false;  ///< LocalPlane::limited
};

/// Rounds in steps of at most 1/200: a tile sees other neighbours for a few cells at its border,
/// which must not change all of its disks.
double rounded_spacing(double median);

/// Medians of spacings, rounded; 0 without any. The order of the spacings does not matter.
TypicalSpacing typical_spacing(std::vector<float> with_beam, std::vector<float> without);

}  // namespace adasplats
