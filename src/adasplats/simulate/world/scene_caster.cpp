// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/scene_caster.h"

#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/simulate/scan/scan_reporter.h"

namespace adasplats {
namespace {

class CpuSceneCaster final : public SceneCaster {
 public:
  CpuSceneCaster(const Tracer& tracer, Vec3d scene_origin, const Executor& executor)
      : tracer_(tracer),
        scene_origin_(scene_origin),
        caster_(make_cpu_scan_caster(tracer, scene_origin, executor)) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    return caster_->cast(sensor, firings, scans, depth, sink);
  }

  ReportTimes report_world(const ScanRules& rules, std::span<const ScanMotion> scans,
                           std::uint64_t first_number, const World* world, const Executor& executor,
                           ScanSink sink) const override {
    const std::unique_ptr<MoreHits> more =
        world == nullptr ? nullptr : world->more_hits(1.0 / rules.sensor().rotation_hz, executor);
    return report_on_cpu(tracer_, scene_origin_, rules, scans, first_number, more.get(), executor,
                         sink);
  }

  ReportTimes report_batches(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const World* world,
                             const Executor& executor, BatchMemory memory,
                             BatchSink sink) const override {
    if (memory == BatchMemory::device)
      throw Error(ErrorKind::unavailable,
                  "the scene is on the CPU: batches in GPU memory need `device` cuda");
    return report_world(rules, scans, first_number, world, executor,
                        [&](std::size_t i, Scan&& scan) { sink(batch_of(i, std::move(scan))); });
  }

  bool has_large_batches() const override { return false; }

 private:
  const Tracer& tracer_;
  Vec3d scene_origin_;
  std::unique_ptr<ScanCaster> caster_;
};

}  // namespace

std::unique_ptr<SceneCaster> make_cpu_scene_caster(const Tracer& tracer, Vec3d scene_origin,
                                                   const Executor& executor) {
  return std::make_unique<CpuSceneCaster>(tracer, scene_origin, executor);
}

}  // namespace adasplats
