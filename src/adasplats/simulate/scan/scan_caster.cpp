// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_caster.h"

#include <atomic>
#include <chrono>
#include <utility>
#include <vector>

#include "adasplats/simulate/scan/scan_reporter.h"

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

  ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                     std::uint64_t first_number, const Executor& executor,
                     ScanSink sink) const override {
    return report_on_cpu(tracer_, scene_origin_, rules, scans, first_number, nullptr, executor,
                         sink);
  }

 private:
  const Tracer& tracer_;
  Vec3d scene_origin_;
  const Executor& executor_;
};

/// The hits of firings [begin, end); gives the nanoseconds in the tracer.
std::int64_t cast_firings(const Tracer& tracer, const ScanRules& rules,
                          std::span<const FiringRay> all_firings, std::span<const ScanPose> knots,
                          std::size_t begin, std::size_t end, const MoreHits* more,
                          std::span<Hit> hits, const Executor& executor) {
  const auto sub_rays = static_cast<std::size_t>(rules.beam().sub_rays);
  const auto t_min = static_cast<float>(rules.sensor().min_range_m);
  const auto t_max = static_cast<float>(rules.sensor().max_range_m);
  const std::span<const FiringRay> firings =
      all_firings.subspan(begin * sub_rays, (end - begin) * sub_rays);
  std::vector<Ray> rays;
  rays.reserve(firings.size());
  for (const FiringRay& firing : firings)
    rays.push_back(
        scan_ray(knots.data(), static_cast<std::uint32_t>(knots.size()), firing, t_min, t_max));
  const int depth = rules.beam().depth;
  const Clock::time_point start = Clock::now();
  if (depth == 1) {
    tracer.nearest(rays, hits, executor);
  } else {
    tracer.nearest_hits(rays, depth, hits, executor);
  }
  if (more != nullptr) more->add(rays, firings, depth, hits);
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

}  // namespace

/// Rays are made, cast and reported chunk by chunk.
ReportTimes report_on_cpu(const Tracer& tracer, Vec3d scene_origin, const ScanRules& rules,
                          std::span<const ScanMotion> scans, std::uint64_t first_number,
                          MoreHits* more, const Executor& executor, ScanCaster::ScanSink sink) {
  ReportTimes times;
  ScanReporter reporter(rules, executor);
  const std::vector<FiringRay> firings = firing_rays(rules.sensor(), rules.cast_firings());
  Scan scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Clock::time_point start = Clock::now();
    const ScanPoses poses(rules, scans[i], scene_origin);
    if (more != nullptr) more->begin(first_number + i, scans[i]);
    std::atomic<std::int64_t> traced_ns = 0;
    reporter.report(
        scans[i], poses, first_number + i,
        [&](std::size_t begin, std::size_t end, std::span<Hit> hits) {
          traced_ns +=
              cast_firings(tracer, rules, firings, poses.knots, begin, end, more, hits, executor);
        },
        scan);
    times.traced_s += 1e-9 * static_cast<double>(traced_ns) / executor.threads();
    times.reported_s += seconds_since(start);
    sink(i, std::move(scan));
  }
  return times;
}

std::unique_ptr<ScanCaster> make_cpu_scan_caster(const Tracer& tracer, Vec3d scene_origin,
                                                 const Executor& executor) {
  return std::make_unique<CpuScanCaster>(tracer, scene_origin, executor);
}

}  // namespace adasplats
