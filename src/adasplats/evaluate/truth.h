// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct TruthOptions {
  bool drop_moving = true;    ///< leave out rays whose true surface is of a moving class
  bool drop_movable = false;  ///< ... of a movable class (parked cars)
};

/// Distances of simulated points to the nearest point of the true surface, m; NaN without points.
/// The median of an even number is the mean of the middle two, the 95th percentile is by nearest
/// rank.
struct DistanceSummary {
  std::size_t points = 0;
  double mean_m = 0;
  double median_m = 0;
  double p95_m = 0;
  double rmse_m = 0;
};

/// Accuracy over rays that meet the true surface.
struct TruthAccuracy {
  BeamAccuracy range;  ///< simulated - true range; `rays` counts the rays that meet the truth
  /// Share of these rays that fall through the model: they hit nothing, or something more than 50
  /// cm behind the true surface. NaN without rays.
  double hole_share = 0;
  DistanceSummary surface;  ///< of the points that these rays simulate
};

struct TruthResult {
  std::size_t rays = 0;  ///< cast, without those on left-out classes
  TruthAccuracy all;     ///< `surface` is of the points of all rays, ghosts included
  /// Share of the rays without a true surface in range that hit the model. NaN without such rays.
  double ghost_share = 0;
  /// Share of the simulated points between two objects: farther than 10 cm from the true surface,
  /// and with a margin of 10 cm between the nearest and the farthest of the true ranges of the beam
  /// and its neighbours (beam_neighbors). NaN without points.
  double bleeding_share = 0;
  std::vector<std::pair<std::string, TruthAccuracy>> by_class;  ///< of the true triangle, by id
};

/// Casts the rays of a sensor at the poses, without noise and within the sensor's ranges, into a
/// model with local origin `model_origin` and into the true surface, and compares. `labels` names
/// the mesh's classes; without it they are "class N" and none is left out. Errors: data (no poses,
/// no triangles, a class of the mesh that `labels` does not have), usage (a pattern that does not
/// repeat).
TruthResult compare_with_truth(const Tracer& model, Vec3d model_origin, const MeshModel& truth,
                               const LabelScheme* labels, const LidarModel& sensor,
                               const Trajectory& poses, const TruthOptions& options,
                               const Executor& executor, ProgressSink& progress);

/// The neighbours of each beam of firings_of(sensor), by index; kNoBeam if there is none: the
/// previous and the next in azimuth on its ring (around the full turn), and the beams of the same
/// column on the rings above and below. A free pattern has no columns: only the previous and the
/// next beam on the ring, in the pattern's order.
inline constexpr std::uint32_t kNoBeam = 0xffffffffU;
std::vector<std::array<std::uint32_t, 4>> beam_neighbors(const LidarModel& sensor);

}  // namespace adasplats
