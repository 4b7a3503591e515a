// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct Scan;
class ScanRules;

/// What casting the scans of a trajectory took. Where devices and copies overlap, the sums of parts
/// are larger than the whole.
struct CastTimes {
  double traced_s = 0;    ///< in the tracer, or in the kernels of a GPU
  double returned_s = 0;  ///< from the first launch until the last hit was in host memory, without
                          ///< the time that the sink took
};

/// What simulating scans took.
struct ReportTimes {
  /// In the tracer, as if it had run alone: on the CPU the threads' share, on a GPU its kernels.
  double traced_s = 0;
  double reported_s = 0;  ///< until the last scan was there, without the time that the sink took

  ReportTimes& operator+=(const ReportTimes& other) {
    traced_s += other.traced_s;
    reported_s += other.reported_s;
    return *this;
  }
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

  /// Takes scan i of a call. What it moves out of `scan` is its own; memory that it leaves is used
  /// for the next scans.
  using ScanSink = FunctionRef<void(std::size_t i, Scan&& scan)>;

  /// From rays to points: what a sensor reports by `rules`, scan by scan in their order, on the
  /// caller's thread, with work on the executor's. Scan i has the number `first_number` + i. The
  /// same bytes on the CPU and on GPUs, for any number of threads. An exception of the sink ends
  /// the casting and reaches the caller.
  virtual ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const Executor& executor,
                             ScanSink sink) const = 0;
};

/// Casts with a tracer, scan by scan. `scene_origin`: world coordinates of the scene's local
/// origin. Tracer and executor must outlive it.
std::unique_ptr<ScanCaster> make_cpu_scan_caster(const Tracer& tracer, Vec3d scene_origin,
                                                 const Executor& executor);

}  // namespace adasplats
