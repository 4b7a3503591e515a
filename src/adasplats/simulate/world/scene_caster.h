// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/simulate/scan/scan_batch.h"
#include "adasplats/simulate/scan/scan_caster.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// Memory of batches of scans.
enum class BatchMemory : std::uint8_t {
  host,    ///< page-locked for a GPU, and reused once the batch is released
  device,  ///< of the first GPU; complete when the sink is called
};

/// Casts into a scene and the objects of its world, on the CPU or on GPUs.
class SceneCaster : public ScanCaster {
 public:
  /// Casts without objects.
  ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                     std::uint64_t first_number, const Executor& executor,
                     ScanSink sink) const final {
    return report_world(rules, scans, first_number, nullptr, executor, sink);
  }
  /// The same with the objects of `world`, whose scan `first_number` is the first; null: none.
  virtual ReportTimes report_world(const ScanRules& rules, std::span<const ScanMotion> scans,
                                   std::uint64_t first_number, const World* world,
                                   const Executor& executor, ScanSink sink) const = 0;

  using BatchSink = FunctionRef<void(ScanBatch&& batch)>;
  /// The same in batches, in order and without a copy. A batch contains the scans of one launch on
  /// a GPU (fewer if its memory is small), or one scan on the CPU. Errors: unavailable (not enough
  /// GPU memory for one scan; device memory on the CPU).
  virtual ReportTimes report_batches(const ScanRules& rules, std::span<const ScanMotion> scans,
                                     std::uint64_t first_number, const World* world,
                                     const Executor& executor, BatchMemory memory,
                                     BatchSink sink) const = 0;
  /// Whether batches contain many scans and need no copy.
  virtual bool has_large_batches() const = 0;
};

/// Casts with a tracer, scan by scan. `scene_origin`: world coordinates of the scene's local
/// origin. Tracer and executor must outlive it.
std::unique_ptr<SceneCaster> make_cpu_scene_caster(const Tracer& tracer, Vec3d scene_origin,
                                                   const Executor& executor);

}  // namespace adasplats
