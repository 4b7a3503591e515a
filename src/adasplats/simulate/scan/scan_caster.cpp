// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_caster.h"

#include <chrono>
#include <vector>

#include "adasplats/simulate/scan/scan.h"

namespace adasplats {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class CpuScanCaster final : public ScanCaster {
 public:
  CpuScanCaster(const Tracer& tracer, Vec3d scene_origin, const Executor& executor)
      : tracer_(tracer), scene_origin_(scene_origin), executor_(executor) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    CastTimes times;
    std::vector<Hit> hits(firings.size() * static_cast<std::size_t>(depth));
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const Clock::time_point start = Clock::now();
      const std::vector<Ray> rays = scan_rays(sensor, firings, scans[i], scene_origin_, executor_);
      const Clock::time_point rays_made = Clock::now();
      if (depth == 1) {
        tracer_.nearest(rays, hits, executor_);
      } else {
        tracer_.nearest_hits(rays, depth, hits, executor_);
      }
      times.traced_s += seconds_since(rays_made);
      times.returned_s += seconds_since(start);
      sink(i, hits);
    }
    return times;
  }

 private:
  const Tracer& tracer_;
  Vec3d scene_origin_;
  const Executor& executor_;
};

}  // namespace

std::unique_ptr<ScanCaster> make_cpu_scan_caster(const Tracer& tracer, Vec3d scene_origin,
                                                 const Executor& executor) {
  return std::make_unique<CpuScanCaster>(tracer, scene_origin, executor);
}

}  // namespace adasplats
