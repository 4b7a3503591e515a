// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/ray_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "adasplats/splats/present_disks.h"

namespace adasplats {
namespace {

constexpr std::size_t kGrain = 16384;
constexpr std::size_t kRaysAtOnce = std::size_t{1} << 18;
constexpr double kUnit = 1.0 / (1 << 20);  // of the sums: 1e-6 of a ray, 1e-6 m

/// Radius that encloses that many of the rings.
float radius_of(int rings, float radius_m) {
  return radius_m * std::sqrt(static_cast<float>(rings) / RayEvidence::kBins);
}

/// Sums over the rays of one disk, in units of kUnit.
struct ShiftSums {
  std::int64_t weight = 0;
  std::int64_t shift = 0;
  std::uint32_t rays = 0;
};

template <class T>
void add(T& sum, T value) {
  std::atomic_ref<T>(sum).fetch_add(value, std::memory_order_relaxed);
}

/// What one ray adds to the disk that it meets first.
void add_ray(ShiftSums& sums, const Ray& ray, float hit_t, float range_m, const Disk& disk,
             const SettleOptions& options) {
  const double error_m = static_cast<double>(hit_t) - static_cast<double>(range_m);
  if (std::fabs(error_m) > options.reach_m) return;
  const double cosine = std::max(options.least_cosine,
                                 std::fabs(static_cast<double>(dot(disk.normal, ray.direction))));
  const double relative = error_m / options.scale_m;
  const double weight = 1.0 / ((1.0 + relative * relative) * cosine * cosine);
  const Vec3f point = ray.origin + range_m * ray.direction;
  const auto shift_m = static_cast<double>(dot(point - disk.center, disk.normal));
  add(sums.weight, static_cast<std::int64_t>(std::llround(weight / kUnit)));
  add(sums.shift, static_cast<std::int64_t>(std::llround(weight * shift_m / kUnit)));
  add(sums.rays, std::uint32_t{1});
}

std::vector<ShiftSums> sum_shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                  const SettleOptions& options, const Executor& executor) {
  std::vector<ShiftSums> sums(disks.size());
  const PresentDisks present(disks, executor);
  if (present.empty()) return sums;
  const auto reach_m = static_cast<float>(options.reach_m);
  std::vector<Ray> batch;
  std::vector<Hit> hits;
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    batch.resize(count);
    hits.assign(count, Hit{});
    executor.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) batch[k] = rays.ray(first + k, reach_m);
    });
    present.tracer().nearest(batch, hits, executor);
    executor.for_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (!hits[k].valid()) continue;
        const std::uint32_t id = present.id(hits[k].primitive);
        add_ray(sums[id], batch[k], hits[k].t, rays.range_m(first + k), disks[id], options);
      }
    });
  }
  return sums;
}

}  // namespace

bool DiskEvidence::seen() const {
  const auto any = [](std::span<const std::uint32_t> counts) {
    return std::any_of(counts.begin(), counts.end(), [](std::uint32_t n) { return n > 0; });
  };
  return any(confirmed) || any(contradicted);
}

DiskEvidence evidence_of(const RayEvidence& evidence, std::size_t disk) {
  const auto part = [disk](const std::vector<std::uint32_t>& counts) {
    return std::span(counts).subspan(disk * RayEvidence::kBins, RayEvidence::kBins);
  };
  return {part(evidence.confirmed), part(evidence.contradicted)};
}

float balanced_radius(const DiskEvidence& evidence, float radius_m) {
  std::int64_t balance = 0, best = 0;
  int rings = 0;      // of the best radius
  int last_seen = 0;  // outermost ring that any ray crossed
  for (int k = 0; k < RayEvidence::kBins; ++k) {
    const auto bin = static_cast<std::size_t>(k);
    const std::int64_t yes = evidence.confirmed[bin], no = evidence.contradicted[bin];
    balance += yes - no;
    if (yes + no > 0) last_seen = k + 1;
    if (balance > best || (balance == best && yes > 0)) {
      best = balance;
      rings = k + 1;
    }
  }
  // Rings that nobody crossed stay, and so do disks.
  return rings == last_seen ? radius_m : radius_of(rings, radius_m);
}

bool is_borne_out(const DiskEvidence& evidence) {
  double balance = 0, best = 0, contradicted = 0;
  for (std::size_t bin = 0; bin < evidence.confirmed.size(); ++bin) {
    balance += static_cast<double>(evidence.confirmed[bin]);
    balance -= static_cast<double>(evidence.contradicted[bin]);
    contradicted += static_cast<double>(evidence.contradicted[bin]);
    best = std::max(best, balance);
  }
  return balance >= 0 || best * best >= contradicted;
}

float judged_radius(const DiskEvidence& evidence, float radius_m, const JudgeOptions& options) {
  const float balanced_m = is_borne_out(evidence) ? balanced_radius(evidence, radius_m) : 0;
  if (balanced_m > 0 || radius_m <= options.least_radius_m) return balanced_m;
  const auto core_sum = [&options](std::span<const std::uint32_t> counts) {
    const auto core = counts.first(static_cast<std::size_t>(options.core_rings));
    return std::accumulate(core.begin(), core.end(), std::uint32_t{0});
  };
  const std::uint32_t yes = core_sum(evidence.confirmed), no = core_sum(evidence.contradicted);
  const bool has_chance =
      yes >= options.core_rays && yes >= options.core_share * (double{1} * yes + no);
  return has_chance ? std::max(options.core_radius * radius_m, options.least_radius_m) : 0;
}

float strict_radius(const DiskEvidence& evidence, float radius_m, double most_share) {
  double yes = 0, no = 0;
  int rings = 0;
  for (int k = 0; k < RayEvidence::kBins; ++k) {
    yes += evidence.confirmed[static_cast<std::size_t>(k)];
    no += evidence.contradicted[static_cast<std::size_t>(k)];
    if (no <= most_share * yes) rings = k + 1;
  }
  return rings == RayEvidence::kBins ? radius_m : radius_of(rings, radius_m);
}

void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor) {
  const std::vector<ShiftSums> sums = sum_shifts(disks, rays, options, executor);
  executor.for_chunks(disks.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (sums[i].rays < options.least_rays) continue;
      const double weight = kUnit * static_cast<double>(sums[i].weight);
      const double prior = options.prior_rays * weight / sums[i].rays;
      const double shift_m =
          std::clamp(kUnit * static_cast<double>(sums[i].shift) / (weight + prior),
                     -options.most_shift_m, options.most_shift_m);
      disks[i].center = disks[i].center + static_cast<float>(shift_m) * disks[i].normal;
    }
  });
}

}  // namespace adasplats
