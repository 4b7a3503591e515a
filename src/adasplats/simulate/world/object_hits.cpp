// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/object_hits.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace adasplats {
namespace {

constexpr std::size_t kRaysPerBundle = 64;  // of one ring: 10 degrees of an HDL-64
static_assert(kFineGrain % kRaysPerBundle == 0);

/// The rays that may hit one object.
struct ObjectRays {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> firings;
  std::vector<double> begins_m;

  void append(const ObjectRays& other) {
    rays.insert(rays.end(), other.rays.begin(), other.rays.end());
    firings.insert(firings.end(), other.firings.begin(), other.firings.end());
    begins_m.insert(begins_m.end(), other.begins_m.begin(), other.begins_m.end());
  }
};

ObjectRays rays_in_object(const ScanRays& scan, const ObjectSighting& object,
                          const ObjectPose* knots, const Executor& executor) {
  const WorldSphere sphere = {object.center, object.radius_m};
  const auto take = [&](std::size_t i, ObjectRays& part) {
    ObjectRay made;
    if (!object_ray(object, knots, scan.rays[i], scan.firings[i].share, made)) return;
    part.rays.push_back(made.ray);
    part.firings.push_back(static_cast<std::uint32_t>(i));
    part.begins_m.push_back(made.begin_m);
  };
  std::vector<ObjectRays> parts((scan.rays.size() + kFineGrain - 1) / kFineGrain);
  executor.for_chunks(scan.rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    ObjectRays& part = parts[begin / kFineGrain];
    for (std::size_t first = begin; first < end; first += kRaysPerBundle) {
      if (!scan.bundles[first / kRaysPerBundle].may_meet(sphere)) continue;
      const std::size_t behind = std::min(end, first + kRaysPerBundle);
      for (std::size_t i = first; i < behind; ++i) take(i, part);
    }
  });
  ObjectRays all;
  for (const ObjectRays& part : parts) all.append(part);
  return all;
}

/// Restores the ascending order of `found`.
void to_scan(std::span<Hit> found, const ObjectSighting& object, double begin_m, const Ray& ray) {
  for (Hit& hit : found) hit = scan_hit(hit, object, begin_m, ray);
  // Different distances in the object may round to the same distance in the world.
  std::sort(found.begin(), found.end());
}

/// Merges the nearest of both ascending lists into `hits`.
void merge_nearest(std::span<Hit> hits, std::span<const Hit> found, std::vector<Hit>& buffer) {
  buffer.resize(hits.size() + found.size());
  std::merge(hits.begin(), hits.end(), found.begin(), found.end(), buffer.begin());
  std::copy_n(buffer.begin(), hits.size(), hits.begin());
}

}  // namespace

RayBundle::RayBundle(std::span<const Ray> rays) : reach_m(static_cast<double>(rays[0].t_max)) {
  const Vec3d first = vec_cast<double>(rays[0].origin);
  WorldBox box = {first, first};
  Vec3d sum;
  for (const Ray& ray : rays) {
    box.add(vec_cast<double>(ray.origin));
    sum = sum + vec_cast<double>(ray.direction);
  }
  origins = {box.center(), 0.5 * length(box.size())};
  if (!(length(sum) > 0)) return;  // rays in all directions: they may hit any sphere
  axis = normalized(sum);
  cos_half = 1;
  for (const Ray& ray : rays)
    cos_half = std::min(cos_half, dot(axis, vec_cast<double>(ray.direction)));
  // Directions have unit length to 2e-7; near 1 that is much of a small angle.
  constexpr double kRounding = 1e-6;
  cos_half -= kRounding;
}

/// Seen from the cone's apex, the sphere has the half angle asin(radius / distance); it is outside
/// if the angle to its centre exceeds the sum of that and the cone's half angle.
bool RayBundle::may_meet(const WorldSphere& sphere) const {
  const Vec3d to_center = sphere.center - origins.center;
  const double radius = sphere.radius + origins.radius;
  const double distance = length(to_center);
  if (distance <= radius) return true;
  if (distance - radius > reach_m) return false;
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  if (cos_half <= -cosine) return true;  // the two angles are 180 degrees or more
  const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
  return dot(axis, to_center) >= distance * (cos_half * cosine - sin_half * sine);
}

std::vector<RayBundle> bundles_of(std::span<const Ray> rays) {
  std::vector<RayBundle> bundles;
  bundles.reserve(rays.size() / kRaysPerBundle + 1);
  for (std::size_t first = 0; first < rays.size(); first += kRaysPerBundle)
    bundles.emplace_back(rays.subspan(first, std::min(kRaysPerBundle, rays.size() - first)));
  return bundles;
}

void add_object_hits(const ScanRays& scan, const ObjectSighting& object, const ObjectPose* knots,
                     const Tracer& tracer, int depth, std::span<Hit> hits,
                     const Executor& executor) {
  const ObjectRays local = rays_in_object(scan, object, knots, executor);
  if (local.rays.empty()) return;
  const auto slots = static_cast<std::size_t>(depth);
  std::vector<Hit> found(local.rays.size() * slots);
  if (depth == 1) {
    tracer.nearest(local.rays, found, executor);
  } else {
    tracer.nearest_hits(local.rays, depth, found, executor);
  }
  executor.for_chunks(local.rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Hit> buffer;
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<Hit> of_ray = std::span(found).subspan(i * slots, slots);
      if (!of_ray.front().valid()) continue;
      const std::size_t firing = local.firings[i];
      to_scan(of_ray, object, local.begins_m[i], scan.rays[firing]);
      merge_nearest(hits.subspan(firing * slots, slots), of_ray, buffer);
    }
  });
}

}  // namespace adasplats
