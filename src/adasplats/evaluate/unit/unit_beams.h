// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/evaluate/echoes/echo_accuracy.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/ray_drop.h"

namespace adasplats {

/// A beam fired by a real sensor, with the prediction of a model of the scene.
struct SensorBeam {
  std::uint32_t scan = 0;    ///< number in the sequence
  std::uint32_t place = 0;   ///< standpoints_of()
  std::uint32_t column = 0;  ///< azimuth step within its ring; the next beam's is one more
  std::uint16_t ring = 0;    ///< topmost 0
  bool hit = false;          ///< the model is hit; otherwise its values are invalid
  float range_m = 0;         ///< measured, corrected by the lasers' offsets; NaN: no return
  float intensity = 0;       ///< measured; NaN: no return or unknown
  float expected_m = 0;      ///< range of the model
  float cos_incidence = 1;
  float reflectance = 0;         ///< of the model; NaN: unknown
  float expected_intensity = 0;  ///< with the model's response; NaN: unknown
  float drop_log_odds = 0;       ///< of the model (SplatModel)
  Vec3f direction;               ///< in the scan's frame

  bool returned() const { return range_m == range_m; }
  /// With the direction.
  EchoConditions conditions() const {
    return {expected_m, cos_incidence, reflectance, direction, drop_log_odds};
  }
};

inline bool same_ring(const SensorBeam& a, const SensorBeam& b) {
  return a.scan == b.scan && a.ring == b.ring;
}

/// Whether three neighbouring beams of a ring returned from one surface: ranges less than 0.3 m
/// apart, as in the statistics of the realism test.
inline bool on_one_surface(const SensorBeam& a, const SensorBeam& b, const SensorBeam& c) {
  constexpr float kOneSurface_m = 0.3F;
  return same_ring(a, c) && std::fabs(b.range_m - a.range_m) < kOneSurface_m &&
         std::fabs(c.range_m - b.range_m) < kOneSurface_m;
}

/// Absolute second difference of three neighbouring values.
inline float second_difference(float a, float b, float c) { return std::fabs(a - 2 * b + c); }

/// All beams of the scans `indices` of a sequence with a recognised sensor, scan by scan, ring by
/// ring, clockwise. Beams without return are inferred from `step_rad` in the gaps between returns
/// of a ring, and before its first and after its last return within the azimuths of the scan; their
/// directions are interpolated, or those of the nearest return. Errors: those of read_kitti_scan.
std::vector<SensorBeam> collect_unit_beams(const EchoScene& scene, const KittiSequence& sequence,
                                           std::span<const std::size_t> indices,
                                           std::span<const double> heights_m, double step_rad,
                                           const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
