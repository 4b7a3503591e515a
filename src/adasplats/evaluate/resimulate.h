// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/evaluate/intensity_agreement.h"
#include "adasplats/scene/scene.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/simulate/world/world.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct ResimulateOptions {
  double min_range_m = 2.5;  ///< beams with measured ranges outside these are left out
  double max_range_m = 50.0;
  bool drop_moving = true;    ///< leave out beams on moving classes and in boxes of moving objects
  bool drop_movable = false;  ///< leave out beams on movable classes (parked cars) as well
};

/// Accuracy of predicted ranges over a set of beams. Shares are 0..1 of all rays; range errors are
/// predicted - measured over the rays that hit, in m.
struct BeamAccuracy {
  std::size_t rays = 0;
  double no_hit = 0;
  double early_50cm = 0;
  double late_50cm = 0;
  std::map<double, double> within;  ///< by bound in m: 0.02, 0.05, 0.10, 0.50
  double median_m = 0;              ///< of |error|
  double mae_m = 0;
  double rmse_m = 0;
  double p90_m = 0;     ///< of |error|
  double bias_m = 0;    ///< median of the errors themselves: late where positive
  double spread_m = 0;  ///< median of |error - bias_m|
};

/// The single beams of one scan.
struct ScanErrors {
  std::vector<Vec3f> measured;            ///< sensor frame, m
  std::vector<float> errors_m;            ///< predicted - measured range; NaN: no hit
  std::vector<std::uint32_t> primitives;  ///< hit by each beam; Hit::kNone: none
};

/// Whether single beams are kept, 20 bytes each.
enum class KeepBeams : std::uint8_t { no, yes };

struct ResimulateResult {
  BeamAccuracy all;
  /// The beams at least as far upward in the world as the beams identified as without return
  /// (EmptyBeamOptions::min_up).
  BeamAccuracy upward;
  std::string beams;  ///< source of their origins (ScanBeams::description)
  /// Predicted against measured points of each scan, the mean over scans (as lidar-nerf and LiDAR4D
  /// average over frames); NaN if no beam hits. Point counts are sums.
  CloudDistance clouds;
  /// Of beams with an error of at most 50 cm; nothing unless both sides have intensities.
  std::optional<IntensityAgreement> intensities;
  std::vector<std::pair<std::string, BeamAccuracy>> by_range;      ///< "2.5-10 m", ...
  std::vector<std::pair<std::string, BeamAccuracy>> by_incidence;  ///< "0-30 deg" ... to the normal
  std::vector<std::pair<std::string, BeamAccuracy>> by_surroundings;  ///< flat, rough, edge
  /// "still", "moving": in boxes of moving objects and of moving classes; empty if `drop_moving`
  /// and without boxes or labels.
  std::vector<std::pair<std::string, BeamAccuracy>> by_motion;
  /// Of the moving ones, object by object: "73 Car" of the boxes, or "moving-car 5", class and
  /// instance of the labels.
  std::vector<std::pair<std::string, BeamAccuracy>> by_object;
  std::vector<std::pair<std::string, BeamAccuracy>> by_class;  ///< names of the label scheme
  /// "-25 deg", ...: elevation of the beam in the sensor's frame, rounded down. Different biases
  /// show differences between lasers, which no model can predict.
  std::vector<std::pair<std::string, BeamAccuracy>> by_elevation;
  std::vector<ScanErrors> errors;  ///< one per scan of the sequence; empty unless beams are kept
};

/// What beams are cast into.
struct BeamScene {
  const Tracer& tracer;
  const PrimitiveAttributes& attributes;
  Vec3d origin;                  ///< world coordinates of its local origin, m
  const World* world = nullptr;  ///< its objects; null: none
};

/// Casts each measured beam of a held-out sequence again, from its origin (sequence.beams) through
/// the measured point, and compares ranges. Incidence is the angle to the normal of the hit
/// surface. `scene.world`: its objects are where they were at the time of each beam (or of its
/// scan, if points have no times); their hits count in all figures but those by incidence and of
/// intensities.
ResimulateResult resimulate(const BeamScene& scene, const KittiSequence& sequence,
                            const LabelScheme& labels, const ResimulateOptions& options,
                            const Executor& executor, ProgressSink& progress,
                            KeepBeams keep = KeepBeams::no);

/// Moves every scan of a sequence to where its beams fit the scene best, as if its pose had no
/// error. Point to plane along the beams, against the normals of the surfaces that they hit, with
/// weights that decrease with distance (Geman-McClure, 15 to 3 cm). The scans are aligned with the
/// scene that they are then compared with, so the remaining errors are those of the scene alone.
void register_scans(const Tracer& tracer, const SceneView& scene, Vec3d scene_origin,
                    KittiSequence& sequence, const LabelScheme& labels,
                    const ResimulateOptions& options, const Executor& executor,
                    ProgressSink& progress);

}  // namespace adasplats
