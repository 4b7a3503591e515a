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
      : caster_(make_cpu_scan_caster(tracer, scene_origin, executor)) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    return caster_->cast(sensor, firings, scans, depth, sink);
  }

  ReportTimes report_world(const ScanRules& rules, std::span<const ScanMotion> scans,
                           std::uint64_t first_number, const World* world, const Executor& executor,
                           ScanSink sink) const override {
    if (world == nullptr) return caster_->report(rules, scans, first_number, executor, sink);
    const LidarModel& sensor = rules.sensor();
    const std::span<const Firing> firings = rules.cast_firings();
    const int depth = rules.beam().depth;
    ScanReporter reporter(rules, executor);
    ReportTimes times;
    std::vector<Hit> all;
    Scan scan;
    const auto report_hits = [&](std::size_t i, std::span<const Hit> hits) {
      const Stopwatch watch;
      all.assign(hits.begin(), hits.end());
      world->add_hits(first_number + i, sensor, firings, scans[i], 1.0 / sensor.rotation_hz, depth,
                      all, executor);
      times.traced_s += watch.seconds();
      reporter.report(scans[i], ScanPoses(rules, scans[i], world->scene_origin()), first_number + i,
                      all, scan);
      times.reported_s += watch.seconds();
      sink(i, std::move(scan));
    };
    const CastTimes cast_times = caster_->cast(sensor, firings, scans, depth, report_hits);
    times.traced_s += cast_times.traced_s;
    times.reported_s += cast_times.returned_s;
    return times;
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
  std::unique_ptr<ScanCaster> caster_;
};

}  // namespace

std::unique_ptr<SceneCaster> make_cpu_scene_caster(const Tracer& tracer, Vec3d scene_origin,
                                                   const Executor& executor) {
  return std::make_unique<CpuSceneCaster>(tracer, scene_origin, executor);
}

}  // namespace adasplats
