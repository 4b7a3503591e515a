// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/ray_drop.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// A model as its echoes are compared: where rays end, and what is there.
struct EchoScene {
  const Tracer& tracer;
  PrimitiveAttributes attributes;  ///< with the view
  Vec3d origin;                    ///< world coordinates of the local origin
};

/// What a ray that hits the scene meets, as the drop model sees it; the direction is not filled.
EchoConditions echo_of(const EchoScene& scene, const Ray& ray, const Hit& hit);

/// Predicted against measured intensities of beams that hit the model, in the unit of the file.
struct IntensityAccuracy {
  std::size_t rays = 0;
  double rank_correlation = 0;  ///< Spearman's; NaN where one side does not vary
  double mae = 0;
};

/// Spearman's rank correlation, equal values sharing the mean of their ranks; NaN for fewer than
/// two pairs or where one side does not vary. Throws std::logic_error where sizes differ.
double rank_correlation(std::span<const float> a, std::span<const float> b);

/// Casts the measured beams of the scans `indices` of a held-out sequence again, from where they
/// started (sequence.beams). Errors: data (a model without intensities, no beam with an intensity
/// that hits), those of read_kitti_scan.
IntensityAccuracy intensity_accuracy(const EchoScene& scene, const KittiSequence& sequence,
                                     std::span<const std::size_t> indices, const Executor& executor,
                                     ProgressSink& progress);

/// All beams of measured scans, also those that found nothing, with what a model says of them. All
/// arrays have the same size.
struct BeamEchoes {
  std::vector<EchoConditions> echoes;  ///< where the model is hit; else the direction alone counts
  std::vector<std::uint8_t> hit;       ///< 1: the beam hits the model within the sensor's range
  std::vector<std::uint8_t> lost;      ///< 1: the real beam found nothing
  std::vector<std::uint32_t> places;   ///< that it was fired from (standpoints_of())

  std::size_t size() const { return echoes.size(); }
};

/// Finds the beams of the scans `indices` (find_beam_grid) and casts them; `motions`: of all scans
/// of the sequence. Errors: those of find_beam_grid, with the file.
BeamEchoes collect_beam_echoes(const EchoScene& scene, const KittiSequence& sequence,
                               std::span<const std::size_t> indices, const LidarModel& sensor,
                               std::span<const ScanMotion> motions, const Executor& executor,
                               ProgressSink& progress);

/// Fits where a real sensor reports nothing of what its beams hit: blocked sectors first, the
/// logistic model to the rest. Errors: those of fit_ray_drop.
RayDropModel fit_ray_drop(const BeamEchoes& beams);

/// How well beams without return are foretold: such a beam hits nothing, or its drop is more
/// likely than not.
struct DropAccuracy {
  std::size_t beams = 0;
  std::size_t empty = 0;      ///< that really found nothing
  std::size_t predicted = 0;  ///< said to find nothing
  std::size_t right = 0;      ///< both

  double precision() const;  ///< NaN where none is predicted
  double recall() const;     ///< NaN where none is empty
  double f1() const;         ///< 0 where none is right; NaN where there is nothing to find
};

/// `model`: null for hits and misses alone. `with_blocked` = false leaves out the beams that the
/// model says are blocked.
DropAccuracy drop_accuracy(const BeamEchoes& beams, const RayDropModel* model,
                           bool with_blocked = true);

}  // namespace adasplats
