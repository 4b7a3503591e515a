// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/object_hits.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace adasplats {
namespace {

constexpr std::size_t kRaysPerBundle = 64;  // of one ring: 10 degrees of an HDL-64
/// Rays that a thread casts into one object after the other.
constexpr std::size_t kRaysPerTask = 16 * kRaysPerBundle;

/// The rays that may hit one object.
struct ObjectRays {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> firings;
  std::vector<double> begins_m;

  void clear() {
    rays.clear();
    firings.clear();
    begins_m.clear();
  }
};

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

/// Casts some rays of a scan into objects.
class RayTask {
 public:
  RayTask(std::span<const Ray> rays, std::span<const FiringRay> firings,
          const SightedObjects& sighted, std::span<Hit> hits, std::size_t slots)
      : rays_(rays), firings_(firings), sighted_(sighted), hits_(hits), slots_(slots) {
    for (std::size_t first = 0; first < rays.size(); first += kRaysPerBundle) {
      bundles_.emplace_back(rays.subspan(first, behind(first) - first));
      double& reach_m = reaches_m_.emplace_back(0);
      for (std::size_t i = first; i < behind(first); ++i)
        reach_m = std::max(reach_m, static_cast<double>(reach_of(i)));
    }
  }

  void cast_into(std::size_t number, const Executor& executor) {
    const ObjectSighting& object = sighted_.objects[number];
    find_rays(object);
    if (local_.rays.empty()) return;
    found_.resize(local_.rays.size() * slots_);
    const Tracer& tracer = *sighted_.tracers[number];
    if (slots_ == 1)
      tracer.nearest(local_.rays, found_, executor);
    else
      tracer.nearest_hits(local_.rays, static_cast<int>(slots_), found_, executor);
    for (std::size_t i = 0; i < local_.rays.size(); ++i) {
      const std::span<Hit> of_ray = std::span(found_).subspan(i * slots_, slots_);
      if (!of_ray.front().valid()) continue;
      const std::size_t firing = local_.firings[i];
      to_scan(of_ray, object, local_.begins_m[i], rays_[firing]);
      merge_nearest(hits_.subspan(firing * slots_, slots_), of_ray, buffer_);
    }
  }

 private:
  std::size_t behind(std::size_t first) const {
    return std::min(rays_.size(), first + kRaysPerBundle);
  }
  /// Hits of objects beyond it do not count, m.
  float reach_of(std::size_t i) const {
    const Hit& last = hits_[(i + 1) * slots_ - 1];
    return last.valid() ? last.t : rays_[i].t_max;
  }

  void find_rays(const ObjectSighting& object) {
    local_.clear();
    const WorldSphere sphere = {object.center, object.radius_m};
    for (std::size_t first = 0; first < rays_.size(); first += kRaysPerBundle) {
      const std::size_t bundle = first / kRaysPerBundle;
      if (!bundles_[bundle].may_meet(sphere, reaches_m_[bundle])) continue;
      for (std::size_t i = first; i < behind(first); ++i) {
        ObjectRay made;
        if (!object_ray(object, sighted_.knots.data(), rays_[i], firings_[i].share,
                        static_cast<double>(reach_of(i)), made))
          continue;
        local_.rays.push_back(made.ray);
        local_.firings.push_back(static_cast<std::uint32_t>(i));
        local_.begins_m.push_back(made.begin_m);
      }
    }
  }

  std::span<const Ray> rays_;
  std::span<const FiringRay> firings_;
  const SightedObjects& sighted_;
  std::span<Hit> hits_;
  std::size_t slots_;
  std::vector<RayBundle> bundles_;
  std::vector<double> reaches_m_;  ///< of the bundles
  ObjectRays local_;
  std::vector<Hit> found_, buffer_;
};

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
bool RayBundle::may_meet(const WorldSphere& sphere, double limit_m) const {
  const Vec3d to_center = sphere.center - origins.center;
  const double radius = sphere.radius + origins.radius;
  // Most bundles of less than half of the sphere look away from an object.
  const double along = dot(axis, to_center);
  if (cos_half > 0 && along < -radius) return false;
  const double distance = length(to_center);
  if (distance <= radius) return true;
  if (distance - radius > std::min(reach_m, limit_m)) return false;
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  if (cos_half <= -cosine) return true;  // the two angles are 180 degrees or more
  const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
  return along >= distance * (cos_half * cosine - sin_half * sine);
}

void add_object_hits(std::span<const Ray> rays, std::span<const FiringRay> firings,
                     const SightedObjects& sighted, int depth, std::span<Hit> hits,
                     const Executor& executor) {
  const auto slots = static_cast<std::size_t>(depth);
  executor.for_chunks(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    RayTask task(rays.subspan(begin, count), firings.subspan(begin, count), sighted,
                 hits.subspan(begin * slots, count * slots), slots);
    for (std::size_t k = 0; k < sighted.objects.size(); ++k) task.cast_into(k, executor);
  });
}

}  // namespace adasplats
