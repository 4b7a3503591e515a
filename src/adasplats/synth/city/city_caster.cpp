// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_caster.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace adasplats {
namespace {

constexpr int kSectors = 360;
constexpr double kFiringOrigin_m = 0.3;  // maximum distance of a beam's origin from the sensor's

int sector_of(double azimuth) {
  const double share = azimuth / kFullTurn + 0.5;
  return std::clamp(static_cast<int>(share * kSectors), 0, kSectors - 1);
}

/// Whether a ray is inside a box anywhere between t_min and t_max; `inverse` is inverse_of() its
/// direction.
bool hits_box(const Ray& ray, Vec3f inverse, Vec3f low, Vec3f high) {
  float from = ray.t_min;
  float to = ray.t_max;
  const auto axis = [&](float origin, float inverse_direction, float a, float b) {
    const float one = (a - origin) * inverse_direction;
    const float other = (b - origin) * inverse_direction;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  };
  axis(ray.origin.x, inverse.x, low.x, high.x);
  axis(ray.origin.y, inverse.y, low.y, high.y);
  axis(ray.origin.z, inverse.z, low.z, high.z);
  return from <= to;
}

/// The nearest hits so far and their owners.
struct Nearest {
  std::vector<Ray> rays;        ///< t_max is the nearest hit
  std::vector<Vec3f> inverses;  ///< inverse_of() their directions
  std::vector<Hit> hits;
  std::vector<std::uint16_t> owner;  ///< section index, or the number of sections + mover index
};

/// Rays that are cast together, compacted.
struct Batch {
  std::vector<std::uint32_t> indices;
  std::vector<Ray> rays;
  std::vector<Hit> hits;

  void clear() {
    indices.clear();
    rays.clear();
  }
  void cast(const Tracer& tracer, std::size_t owner, Nearest& nearest, const Executor& executor) {
    hits.assign(rays.size(), {});
    tracer.nearest(rays, hits, executor);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const std::uint32_t i = indices[k];
      if (!hits[k].valid() || !(hits[k].t < nearest.hits[i].t)) continue;
      nearest.hits[i] = hits[k];
      nearest.owner[i] = static_cast<std::uint16_t>(owner);
      nearest.rays[i].t_max = hits[k].t;
    }
  }
};

/// Inverse of every component; finite, so that a product with a distance is never NaN.
Vec3f inverse_of(Vec3f direction) {
  const auto inverse = [](float c) { return std::fabs(c) < 1e-30F ? 1e30F : 1.0F / c; };
  return {inverse(direction.x), inverse(direction.y), inverse(direction.z)};
}

/// Casts from near to far: rays that hit a near section are not cast against farther ones.
void cast_pieces(const CityScene& scene, Vec3f sensor, Nearest& nearest, Batch& batch,
                 const Executor& executor) {
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t p = 0; p < scene.sections.size(); ++p) {
    const CitySection& section = *scene.sections[p];
    const Vec3f inside = min(max(sensor, section.low), section.high);
    order.emplace_back(length(inside - sensor), p);
  }
  std::ranges::sort(order);
  std::vector<std::uint32_t> reaching(nearest.rays.size());  // rays that reach the next section
  std::iota(reaching.begin(), reaching.end(), 0U);
  for (const auto& [distance, p] : order) {
    const CitySection& section = *scene.sections[p];
    batch.clear();
    const float nearer = distance - static_cast<float>(kFiringOrigin_m);
    std::erase_if(reaching, [&](std::uint32_t i) { return nearest.rays[i].t_max < nearer; });
    for (const std::uint32_t i : reaching) {
      const Ray& ray = nearest.rays[i];
      if (!hits_box(ray, nearest.inverses[i], section.low, section.high)) continue;
      batch.indices.push_back(i);
      batch.rays.push_back(ray);
    }
    if (!batch.rays.empty()) batch.cast(*section.tracer, p, nearest, executor);
  }
}

Ray ray_in(const RigidTransform& mover_from_world, const Ray& ray) {
  return {vec_cast<float>(mover_from_world * vec_cast<double>(ray.origin)), ray.t_min,
          vec_cast<float>(mover_from_world.rotation * vec_cast<double>(ray.direction)), ray.t_max};
}

void cast_movers(const CityScene& scene, const FiringSectors& sectors,
                 const RigidTransform& world_from_sensor, double range_m, Nearest& nearest,
                 Batch& batch, const Executor& executor) {
  const RigidTransform sensor_from_world = world_from_sensor.inverse();
  for (std::size_t m = 0; m < scene.movers.size(); ++m) {
    const PlacedMover& mover = scene.movers[m];
    const MoverModel& model = scene.models->model(mover.model);
    const RigidTransform mover_from_world = mover.world_from_mover.inverse();
    if (collides(model.low, model.high, mover_from_world * world_from_sensor.translation)) continue;
    const Vec3d middle = 0.5 * vec_cast<double>(model.low + model.high);
    const double radius = 0.5 * length(vec_cast<double>(model.high - model.low));
    const Vec3d center = sensor_from_world * (mover.world_from_mover * middle);
    if (length(center) - radius > range_m) continue;
    batch.clear();
    for (const std::uint32_t i : sectors.towards(center, radius)) {
      const Ray ray = ray_in(mover_from_world, nearest.rays[i]);
      if (!hits_box(ray, inverse_of(ray.direction), model.low, model.high)) continue;
      batch.indices.push_back(i);
      batch.rays.push_back(ray);
    }
    if (!batch.rays.empty())
      batch.cast(*model.tracer, scene.sections.size() + m, nearest, executor);
  }
}

StreetEcho echo_of(const CityScene& scene, const Nearest& nearest, std::size_t i, double noise_m,
                   Random& random) {
  const Hit& hit = nearest.hits[i];
  const std::size_t owner = nearest.owner[i];
  const double noise = noise_m > 0 ? noise_m * random.normal() : 0.0;
  StreetEcho echo = {.ray = static_cast<std::uint32_t>(i),
                     .range_m = static_cast<float>(hit.t + noise)};
  const auto fill = [&](const BuiltMesh& built, const Ray& ray, std::uint16_t instance) {
    echo.reflectance = built.reflectances[hit.primitive];
    echo.class_id = built.mesh.classes[hit.primitive];
    echo.instance = instance;
    echo.intensity =
        street_intensity(built.mesh.triangle(hit.primitive), echo.reflectance, ray, hit.t, random);
  };
  if (owner < scene.sections.size()) {
    const BuiltMesh& built = scene.sections[owner]->built;
    fill(built, nearest.rays[i], built.instances[hit.primitive]);
  } else {
    const PlacedMover& mover = scene.movers[owner - scene.sections.size()];
    fill(scene.models->model(mover.model).built,
         ray_in(mover.world_from_mover.inverse(), nearest.rays[i]), mover.instance);
  }
  return echo;
}

}  // namespace

FiringSectors::FiringSectors(std::span<const Firing> firings) : sectors_(kSectors) {
  for (std::uint32_t i = 0; i < firings.size(); ++i)
    sectors_[sector_of(std::atan2(firings[i].direction.y, firings[i].direction.x))].push_back(i);
}

std::vector<std::uint32_t> FiringSectors::towards(Vec3d center, double radius) const {
  const double level = std::hypot(center.x, center.y);
  const double reach = radius + kFiringOrigin_m;
  const double azimuth = std::atan2(center.y, center.x);
  const double half = level > reach ? std::asin(reach / level) : std::numbers::pi;
  std::vector<std::uint32_t> indices;
  const int first =
      static_cast<int>(std::floor((azimuth - half) / kFullTurn * kSectors)) + kSectors / 2;
  const int last =
      static_cast<int>(std::floor((azimuth + half) / kFullTurn * kSectors)) + kSectors / 2;
  for (int k = first; k <= std::min(last, first + kSectors - 1); ++k) {
    const auto& sector = sectors_[((k % kSectors) + kSectors) % kSectors];
    indices.insert(indices.end(), sector.begin(), sector.end());
  }
  std::ranges::sort(indices);
  return indices;
}

std::vector<StreetEcho> cast_city(const CityScene& scene, const LidarModel& sensor,
                                  std::span<const Firing> firings, const FiringSectors& sectors,
                                  const TimedPose& pose, std::uint64_t seed, std::uint64_t scan,
                                  const Executor& executor) {
  Nearest nearest;
  nearest.rays = street_rays(sensor, firings, pose.world_from_sensor, executor);
  nearest.inverses.reserve(nearest.rays.size());
  for (const Ray& ray : nearest.rays) nearest.inverses.push_back(inverse_of(ray.direction));
  nearest.hits.resize(nearest.rays.size());
  nearest.owner.resize(nearest.rays.size());
  Batch batch;
  cast_movers(scene, sectors, pose.world_from_sensor, sensor.max_range_m, nearest, batch, executor);
  cast_pieces(scene, vec_cast<float>(pose.world_from_sensor.translation), nearest, batch, executor);
  std::vector<StreetEcho> echoes;
  echoes.reserve(nearest.rays.size());
  for (std::size_t i = 0; i < nearest.rays.size(); ++i) {
    if (!nearest.hits[i].valid()) continue;
    Random random(seed, scan, i);
    const StreetEcho echo = echo_of(scene, nearest, i, sensor.range_noise_m, random);
    if (echo.range_m > 0) echoes.push_back(echo);
  }
  return echoes;
}

}  // namespace adasplats
