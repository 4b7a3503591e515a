// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "adasplats/city/tile_grid.h"
#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Memory that modelling takes, a point of the cloud or of a tile with its halo. Peaks were 152 (a
/// station's scan, 1 M points), 243 (SemanticKITTI 00, 2 M), 233 (PandaSet 002, 6.8 M), 223
/// (KITTI-0005, 9.4 M) and 318 (a street with beams without return, 12.3 M).
inline constexpr double kModelBytesAPoint = 340;

/// The same of a GPU's memory. Peaks were 331 (the street, 12.3 M) and 285 (KITTI-0005, 9.3 M).
inline constexpr double kGpuModelBytesAPoint = 340;

/// About how many points a place has, and where.
struct PlaceEstimate {
  static constexpr double kCell_m = 16;
  double points = 0;
  std::map<TileKey, double> cells;  ///< points by squares of kCell_m

  /// Of the tile that takes most, with its halo.
  double max_points_of_tile(double tile_m, double halo_m) const;
};

/// No fewer points than inputs can have, by the sizes of their files. Time: that of listing them.
double max_points_of(std::span<const std::filesystem::path> inputs);

/// Samples about two million points in scans or records of all inputs; reads files without random
/// access as a whole. Errors: those of OpenInputs.
PlaceEstimate estimate_place(const OpenInputs& inputs, Session& session);

/// What suits the memory: whether a place is to be modelled in tiles.
struct TileAdvice {
  double tile_m = 0;   ///< side of tiles; 0: one piece
  double points = 0;   ///< about as many
  double need_gb = 0;  ///< that these take in one piece
  double memory_gb = 0;
  std::size_t at_once = 0;  ///< tiles that fit at a time; 0: as many as suit threads and GPUs
  bool of_gpu = false;      ///< the memory that is too small, or would be first, is a GPU's
};

/// The largest tiles of 64, 32 or 16 m that fit into `memory_gb` (MemoryChoice; 0: three quarters
/// of what the process may use) and into that of every GPU, as often as several are modelled at a
/// time, or fewer at a time if none does; of places that fit as they are, none. The inputs are
/// opened where their size alone does not say that. Errors: data (not even the smallest tiles fit),
/// those of OpenInputs.
TileAdvice advise_tiles(const CityJob& job, Session& session);

}  // namespace adasplats
