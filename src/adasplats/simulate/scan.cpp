// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan.h"

#include <stdexcept>

#include "adasplats/core/random.h"
#include "adasplats/simulate/scan_ray.h"

namespace adasplats {

namespace {

constexpr std::size_t kRaysPerChunk = 4096;

/// Adds the sensor's range noise to the hits; what it then measures outside its range is no return.
void add_range_noise(std::span<Hit> hits, const LidarModel& sensor, std::uint64_t scan_index,
                     std::uint64_t seed, const Executor& executor) {
  const auto nearest_m = static_cast<float>(sensor.min_range_m);
  const auto farthest_m = static_cast<float>(sensor.max_range_m);
  executor.for_chunks(hits.size(), kRaysPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!hits[i].valid()) continue;
      const double noise_m = sensor.range_noise_m * Random(seed, scan_index, i).normal();
      const auto range_m = static_cast<float>(static_cast<double>(hits[i].t) + noise_m);
      const bool measured = range_m > nearest_m && range_m <= farthest_m;
      hits[i] = measured ? Hit{range_m, hits[i].primitive} : Hit{};
    }
  });
}

/// The values of the primitives that were hit; empty where the scene has none.
template <class T>
std::vector<T> gathered(std::span<const T> values, std::span<const Hit> hits,
                        std::span<const std::uint32_t> returns) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(returns.size());
  for (const std::uint32_t ray : returns) {
    if (hits[ray].primitive >= values.size())
      throw std::logic_error("an attribute has fewer values than the scene has primitives");
    result.push_back(values[hits[ray].primitive]);
  }
  return result;
}

}  // namespace

std::vector<Ray> scan_rays(const LidarModel& sensor, std::span<const Firing> firings,
                           const RigidTransform& world_from_sensor, Vec3d scene_origin,
                           const Executor& executor) {
  const ScanPose pose = scan_pose(world_from_sensor, scene_origin);
  const auto t_min = static_cast<float>(sensor.min_range_m);
  const auto t_max = static_cast<float>(sensor.max_range_m);
  std::vector<Ray> rays(firings.size());
  executor.for_chunks(rays.size(), kRaysPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      rays[i] = scan_ray(pose, firings[i].direction, t_min, t_max);
  });
  return rays;
}

Scan scan_of_hits(std::span<const Hit> hits, const PrimitiveAttributes& attributes,
                  const LidarModel& sensor, std::span<const Firing> firings, const TimedPose& pose,
                  std::uint64_t scan_index, const SimulateOptions& options,
                  const Executor& executor) {
  if (hits.size() != firings.size()) throw std::logic_error("a scan needs one hit a firing");
  std::vector<Hit> noisy;
  if (options.range_noise && sensor.range_noise_m > 0) {
    noisy.assign(hits.begin(), hits.end());
    add_range_noise(noisy, sensor, scan_index, options.seed, executor);
    hits = noisy;
  }
  std::vector<std::uint32_t> returns;
  returns.reserve(hits.size());
  for (std::uint32_t i = 0; i < hits.size(); ++i)
    if (hits[i].valid()) returns.push_back(i);

  Scan scan;
  scan.world_from_sensor = pose.world_from_sensor;
  scan.time_s = pose.time_s;
  scan.rays = hits.size();
  scan.positions.reserve(returns.size());
  scan.ranges_m.reserve(returns.size());
  scan.rings.reserve(returns.size());
  scan.times_s.reserve(returns.size());
  for (const std::uint32_t ray : returns) {
    scan.positions.push_back(hits[ray].t * firings[ray].direction);
    scan.ranges_m.push_back(hits[ray].t);
    scan.rings.push_back(firings[ray].ring);
    scan.times_s.push_back(firings[ray].time_s);
  }
  scan.intensities = gathered(attributes.intensities, hits, returns);
  scan.classes = gathered(attributes.classes, hits, returns);
  scan.instances = gathered(attributes.instances, hits, returns);
  return scan;
}

Scan simulate_scan(const Tracer& tracer, const PrimitiveAttributes& attributes, Vec3d scene_origin,
                   const LidarModel& sensor, std::span<const Firing> firings, const TimedPose& pose,
                   std::uint64_t scan_index, const SimulateOptions& options,
                   const Executor& executor) {
  const std::vector<Ray> rays =
      scan_rays(sensor, firings, pose.world_from_sensor, scene_origin, executor);
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits, executor);
  return scan_of_hits(hits, attributes, sensor, firings, pose, scan_index, options, executor);
}

}  // namespace adasplats
