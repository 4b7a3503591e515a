// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/measured_rays.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "adasplats/splats/present_disks.h"

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;
constexpr std::size_t kRaysAtOnce = std::size_t{1} << 17;
constexpr float kSensorCell_m = 0.5F;  // sensor positions that count as one place

/// Interleaves the low 16 bits of two numbers.
std::uint32_t morton(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint32_t v) {
    v = (v | (v << 8)) & 0x00ff00ffU;
    v = (v | (v << 4)) & 0x0f0f0f0fU;
    v = (v | (v << 2)) & 0x33333333U;
    return (v | (v << 1)) & 0x55555555U;
  };
  return spread(x & 0xffffU) | (spread(y & 0xffffU) << 1);
}

/// A direction as a place on the unfolded octahedron, along a Morton curve.
std::uint32_t direction_key(Vec3f d) {
  const float size = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
  if (!(size > 0)) return 0;
  float u = d.x / size, v = d.y / size;
  if (d.z < 0) {
    const float folded_u = (1 - std::fabs(v)) * (u < 0 ? -1.0F : 1.0F);
    v = (1 - std::fabs(u)) * (v < 0 ? -1.0F : 1.0F);
    u = folded_u;
  }
  const auto cell = [](float w) {
    return static_cast<std::uint32_t>(std::clamp((w + 1) * 0.5F * 65535.0F, 0.0F, 65535.0F));
  };
  return morton(cell(u), cell(v));
}

std::uint32_t place_key(Vec3f sensor) {
  std::uint32_t hash = 2166136261U;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int32_t>(std::floor(sensor[axis] / kSensorCell_m));
    hash = (hash ^ static_cast<std::uint32_t>(cell)) * 16777619U;
  }
  return hash;
}

void count_one(std::uint32_t& counter) {
  std::atomic_ref<std::uint32_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

MeasuredRays::MeasuredRays(const PointCloud& cloud, double least_range_m, const Executor& executor)
    : cloud_(cloud) {
  std::vector<std::uint64_t> keys(cloud.size());
  executor.for_chunks(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f sensor = cloud.sensor_positions[i];
      keys[i] = std::uint64_t{place_key(sensor)} << 32 | direction_key(cloud.positions[i] - sensor);
    }
  });
  executor.sort_keys(keys, points_);
  std::erase_if(points_, [&](std::uint32_t i) {
    const double range_m =
        static_cast<double>(length(cloud.positions[i] - cloud.sensor_positions[i]));
    return !(range_m >= least_range_m);
  });
}

float MeasuredRays::range_m(std::size_t i) const {
  const std::uint32_t point = points_[i];
  return length(cloud_.positions[point] - cloud_.sensor_positions[point]);
}

Ray MeasuredRays::ray(std::size_t i, float beyond_m) const {
  const std::uint32_t point = points_[i];
  const Vec3f along = cloud_.positions[point] - cloud_.sensor_positions[point];
  const float range_m = length(along);
  Ray ray;
  ray.origin = cloud_.sensor_positions[point];
  ray.direction = along / range_m;
  ray.t_max = range_m + beyond_m;
  return ray;
}

RayEvidence collect_evidence(std::span<const Disk> disks, const MeasuredRays& rays,
                             const EvidenceOptions& options, const Executor& executor) {
  RayEvidence evidence;
  evidence.confirmed.resize(disks.size() * RayEvidence::kBins);
  evidence.contradicted.resize(disks.size() * RayEvidence::kBins);
  const PresentDisks present(disks, executor);
  if (present.empty()) return evidence;

  const auto depth = static_cast<std::size_t>(options.depth);
  std::vector<Ray> batch;
  std::vector<Hit> hits;
  std::size_t next = options.phase;
  while (next < rays.size()) {
    batch.clear();
    for (; next < rays.size() && batch.size() < kRaysAtOnce; next += options.stride) {
      batch.push_back(rays.ray(next, options.margin_m));
    }
    hits.assign(batch.size() * depth, Hit{});
    present.tracer().nearest_hits(batch, options.depth, hits, executor);
    executor.for_chunks(batch.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Ray& ray = batch[k];
        const float free_until = ray.t_max - 2 * options.margin_m;
        for (std::size_t h = k * depth; h < (k + 1) * depth && hits[h].valid(); ++h) {
          const std::uint32_t id = present.id(hits[h].primitive);
          const Disk& disk = disks[id];
          const Vec3f offset = ray.origin + hits[h].t * ray.direction - disk.center;
          const float area_share = dot(offset, offset) / (disk.radius * disk.radius);
          const int bin = std::clamp(static_cast<int>(area_share * RayEvidence::kBins), 0,
                                     RayEvidence::kBins - 1);
          auto& counts = hits[h].t < free_until ? evidence.contradicted : evidence.confirmed;
          count_one(counts[static_cast<std::size_t>(id) * RayEvidence::kBins +
                           static_cast<std::size_t>(bin)]);
        }
      }
    });
  }
  return evidence;
}

}  // namespace adasplats
