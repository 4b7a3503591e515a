// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// What casting the scans of a trajectory took. Where devices and copies overlap, the sums of parts
/// are larger than the whole.
struct CastTimes {
  double traced_s = 0;    ///< in the tracer, or in the kernels of a GPU
  double returned_s = 0;  ///< from the first launch until the last hit was in host memory, without
                          ///< the time that the sink took
};

/// Casts the firings of a sensor from many poses into one scene, on the CPU or on GPUs.
class ScanCaster {
 public:
  /// Takes the hits of one scan, the nearest `depth` of firings[i] at hits[i * depth + k]; they are
  /// valid during the call only.
  using Sink = FunctionRef<void(std::size_t scan, std::span<const Hit> hits)>;

  virtual ~ScanCaster() = default;

  /// Calls `sink` for every scan, in their order, on the caller's thread. Rays are those of
  /// scan_rays(). An exception of the sink ends the casting and reaches the caller.
  virtual CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                         std::span<const ScanMotion> scans, int depth, Sink sink) const = 0;
};

/// Casts with a tracer, scan by scan. `scene_origin`: world coordinates of the scene's local
/// origin. Tracer and executor must outlive it.
std::unique_ptr<ScanCaster> make_cpu_scan_caster(const Tracer& tracer, Vec3d scene_origin,
                                                 const Executor& executor);

}  // namespace adasplats
