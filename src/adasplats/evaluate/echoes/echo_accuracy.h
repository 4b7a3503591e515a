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

/// A model to compare echoes with.
struct EchoScene {
  const Tracer& tracer;
  PrimitiveAttributes attributes;  ///< with the view
  Vec3d origin;                    ///< world coordinates of the local origin
};

/// The conditions of a hit, as input of the drop model; without the direction.
EchoConditions echo_of(const EchoScene& scene, const Ray& ray, const Hit& hit);

/// The standpoint of each of the scans `indices`: scans less than 2 m from the first scan of a
/// standpoint share its number. What is the same in successive scans is evidence of the vehicle
/// only if the standpoint changes.
std::vector<std::uint32_t> standpoints_of(const KittiSequence& sequence,
                                          std::span<const std::size_t> indices);

/// Predicted against measured intensities of beams that hit the model, in the unit of the file.
struct IntensityAccuracy {
  std::size_t rays = 0;
  double rank_correlation = 0;  ///< Spearman's; NaN if one side does not vary
  double mae = 0;
};

/// Casts the measured beams of the scans `indices` of a held-out sequence again, from their origins
/// (sequence.beams). Errors: data (a model without intensities, no beam with an intensity
/// that hits), those of read_kitti_scan.
IntensityAccuracy intensity_accuracy(const EchoScene& scene, const KittiSequence& sequence,
                                     std::span<const std::size_t> indices, const Executor& executor,
                                     ProgressSink& progress);

/// All beams of measured scans, including those without return, with the model's predictions. All
/// arrays have the same size.
struct BeamEchoes {
  std::vector<EchoConditions>
      echoes;                      ///< if the model is hit; otherwise only the direction is valid
  std::vector<std::uint8_t> hit;   ///< 1: the beam hits the model within the sensor's range
  std::vector<std::uint8_t> lost;  ///< 1: the real beam has no return
  std::vector<std::uint32_t> places;  ///< standpoints_of()

  std::size_t size() const { return echoes.size(); }
};

/// Finds the beams of the scans `indices` (find_beam_grid) and casts them; `motions`: of all scans
/// of the sequence. Errors: those of find_beam_grid, with the file.
BeamEchoes collect_beam_echoes(const EchoScene& scene, const KittiSequence& sequence,
                               std::span<const std::size_t> indices, const LidarModel& sensor,
                               std::span<const ScanMotion> motions, const Executor& executor,
                               ProgressSink& progress);

/// Fits which beams of a real sensor are lost although they hit something: blocked sectors first,
/// the logistic model to the rest. Errors: those of fit_ray_drop.
RayDropModel fit_ray_drop(const BeamEchoes& beams);

/// How well beams without return are predicted: those that hit nothing, or with a drop probability
/// above 0.5.
struct DropAccuracy {
  std::size_t beams = 0;
  std::size_t empty = 0;      ///< beams without return
  std::size_t predicted = 0;  ///< beams predicted to be without return
  std::size_t right = 0;      ///< both

  double precision() const;  ///< NaN if none is predicted
  double recall() const;     ///< NaN if none is empty
  double f1() const;         ///< 0 if none is right; NaN if none is predicted or empty
};

/// `model`: null to predict by hits and misses alone. `with_blocked` = false leaves out the beams
/// in blocked sectors of the model.
DropAccuracy drop_accuracy(const BeamEchoes& beams, const RayDropModel* model,
                           bool with_blocked = true);

}  // namespace adasplats
