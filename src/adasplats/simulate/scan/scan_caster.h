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
#include "adasplats/simulate/scan/scan_ray.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct Scan;
class ScanRules;

/// Time spent on casting the scans of a trajectory. If devices and copies overlap, the parts add up
/// to more than the total.
struct CastTimes {
  double traced_s = 0;    ///< in the tracer, or in the kernels of a GPU
  double returned_s = 0;  ///< from the first launch until the last hit was in host memory, without
                          ///< the time of the sink
};

/// Time spent on simulating scans.
struct ReportTimes {
  /// In the tracer: on the CPU the share of the threads' time, on a GPU the kernels.
  double traced_s = 0;
  double reported_s = 0;  ///< until the last scan was complete, without the time of the sink

  ReportTimes& operator+=(const ReportTimes& other) {
    traced_s += other.traced_s;
    reported_s += other.reported_s;
    return *this;
  }
};

/// Casts the firings of a sensor from many poses into one scene, on the CPU or on GPUs.
class ScanCaster {
 public:
  /// Receives the hits of one scan, the nearest `depth` of firings[i] at hits[i * depth + k], valid
  /// only during the call.
  using Sink = FunctionRef<void(std::size_t scan, std::span<const Hit> hits)>;

  virtual ~ScanCaster() = default;

  /// Calls `sink` for every scan, in order, on the caller's thread. Rays are those of scan_rays().
  /// An exception of the sink ends the cast and is passed to the caller.
  virtual CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                         std::span<const ScanMotion> scans, int depth, Sink sink) const = 0;

  /// Receives scan i of a call. It may move data out of `scan`; remaining memory is reused for the
  /// next scans.
  using ScanSink = FunctionRef<void(std::size_t i, Scan&& scan)>;

  /// Simulates scans by `rules`, from rays to points. Calls the sink scan by scan, in order, on the
  /// caller's thread; the executor's threads do the work. Scan i has the number `first_number` + i.
  /// The bytes are the same on the CPU and on GPUs, for any number of threads. An exception of the
  /// sink ends the cast and is passed to the caller.
  virtual ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const Executor& executor,
                             ScanSink sink) const = 0;
};

/// Hits of what is not in the traced scene, such as moving objects.
class MoreHits {
 public:
  virtual ~MoreHits() = default;
  /// Called before each scan.
  virtual void begin(std::uint64_t scan_index, const ScanMotion& motion) = 0;
  /// Merges hits into those of some rays of the scan, hits[i * depth + k] of rays[i], ascending.
  /// Called by several threads at once.
  virtual void add(std::span<const Ray> rays, std::span<const FiringRay> firings, int depth,
                   std::span<Hit> hits) const = 0;
};

/// ScanCaster::report() on the CPU, with additional hits unless `more` is null.
ReportTimes report_on_cpu(const Tracer& tracer, Vec3d scene_origin, const ScanRules& rules,
                          std::span<const ScanMotion> scans, std::uint64_t first_number,
                          MoreHits* more, const Executor& executor, ScanCaster::ScanSink sink);

/// Casts with a tracer, scan by scan. `scene_origin`: world coordinates of the scene's local
/// origin. Tracer and executor must outlive it.
std::unique_ptr<ScanCaster> make_cpu_scan_caster(const Tracer& tracer, Vec3d scene_origin,
                                                 const Executor& executor);

}  // namespace adasplats
