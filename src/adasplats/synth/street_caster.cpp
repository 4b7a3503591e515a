// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/street_scan.h"

namespace adasplats {
namespace {

constexpr double kBumper_m = 5;  // clearance ahead of and behind a mover
constexpr double kDoor_m = 0.6;  // clearance at its sides

/// A view of a mesh with reflectances and instances.
struct Surfaces {
  const TriangleMesh& mesh;
  std::span<const std::uint16_t> instances;
  std::span<const float> reflectances;
};

bool in_the_way(const MovingObject& object, const RigidTransform& world_from_object,
                Vec3d vehicle) {
  Vec3f low = object.mesh.vertices.front();
  Vec3f high = low;
  for (const Vec3f& vertex : object.mesh.vertices) {
    low = min(low, vertex);
    high = max(high, vertex);
  }
  return collides(low, high, world_from_object.inverse() * vehicle);
}

/// Texture, -1..1, constant in cells of 20 cm: stones, plaster, dirt.
double texture_at(Vec3f p) {
  const auto cell = [](float v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v * 5.0F)));
  };
  return Random(cell(p.x), cell(p.y), cell(p.z)).uniform(-1, 1);
}

}  // namespace

std::vector<Ray> street_rays(const LidarModel& sensor, std::span<const Firing> firings,
                             const RigidTransform& world_from_sensor, const Executor& executor) {
  std::vector<Ray> rays(firings.size());
  executor.for_chunks(firings.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d direction =
          normalized(world_from_sensor.rotation * vec_cast<double>(firings[i].direction));
      const Vec3f origin = vec_cast<float>(world_from_sensor * vec_cast<double>(firings[i].origin));
      rays[i] = {origin, static_cast<float>(sensor.min_range_m), vec_cast<float>(direction),
                 static_cast<float>(sensor.max_range_m)};
    }
  });
  return rays;
}

float street_intensity(const Triangle& triangle, float reflectance, const Ray& ray, float t,
                       Random& random) {
  const Vec3f normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const double cosine = std::fabs(dot(normal, ray.direction)) / length(normal);
  const double incidence = 0.4 + 0.6 * cosine;
  const double far = t / 60.0;
  const double texture =
      1 + 0.12 * texture_at(ray.origin + t * ray.direction) + 0.04 * random.normal();
  return static_cast<float>(
      std::clamp(reflectance * incidence * texture / (1 + far * far), 0.0, 1.0));
}

bool collides(Vec3f low, Vec3f high, Vec3d vehicle) {
  return vehicle.x > low.x - kBumper_m && vehicle.x < high.x + kBumper_m &&
         vehicle.y > low.y - kDoor_m && vehicle.y < high.y + kDoor_m;
}

BuiltMesh movers_at(const Street& street, double time_s, Vec3d vehicle) {
  BuiltMesh placed;
  const double now_s =
      street.traffic_period_s > 0 ? std::fmod(time_s, street.traffic_period_s) : time_s;
  for (const MovingObject& object : street.moving) {
    const Trajectory& trajectory = object.world_from_object;
    if (trajectory.empty() || object.mesh.triangles.empty()) continue;
    if (now_s < trajectory.front().time_s || now_s > trajectory.back().time_s) continue;
    const RigidTransform world_from_object = interpolate(trajectory, now_s);
    if (in_the_way(object, world_from_object, vehicle)) continue;
    TriangleMesh& mesh = placed.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3f& vertex : object.mesh.vertices)
      mesh.vertices.push_back(vec_cast<float>(world_from_object * vec_cast<double>(vertex)));
    for (const auto& t : object.mesh.triangles)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    mesh.classes.insert(mesh.classes.end(), object.mesh.classes.begin(), object.mesh.classes.end());
    placed.instances.resize(mesh.triangles.size(), object.instance);
    placed.reflectances.insert(placed.reflectances.end(), object.reflectances.begin(),
                               object.reflectances.end());
  }
  return placed;
}

StreetCaster::StreetCaster(const Street& street, double range_noise_m, const Executor& executor)
    : street_(street),
      range_noise_m_(range_noise_m),
      executor_(executor),
      fixed_(make_cpu_tracer(SceneView{{}, &street.fixed}, executor)) {}

std::vector<StreetEcho> StreetCaster::cast(const LidarModel& sensor,
                                           std::span<const Firing> firings, const TimedPose& pose,
                                           std::uint64_t seed, std::uint64_t scan) const {
  const BuiltMesh movers = movers_at(street_, pose.time_s, pose.world_from_sensor.translation);
  const std::vector<Ray> rays = street_rays(sensor, firings, pose.world_from_sensor, executor_);
  std::vector<Hit> fixed_hits(rays.size());
  std::vector<Hit> moving_hits(rays.size());
  fixed_->nearest(rays, fixed_hits, executor_);
  if (!movers.mesh.triangles.empty())
    make_cpu_tracer(SceneView{{}, &movers.mesh}, executor_)->nearest(rays, moving_hits, executor_);

  const Surfaces fixed = {street_.fixed, street_.instances, street_.reflectances};
  const Surfaces moving = {movers.mesh, movers.instances, movers.reflectances};
  constexpr std::uint32_t kMiss = 0xffffffffU;
  std::vector<StreetEcho> echoes(rays.size());
  executor_.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool mover = moving_hits[i].t < fixed_hits[i].t;
      const Hit hit = mover ? moving_hits[i] : fixed_hits[i];
      echoes[i].ray = kMiss;
      if (!hit.valid()) continue;
      const Surfaces& surfaces = mover ? moving : fixed;
      Random random(seed, scan, i);
      const double noise = range_noise_m_ > 0 ? range_noise_m_ * random.normal() : 0.0;
      const float intensity =
          street_intensity(surfaces.mesh.triangle(hit.primitive),
                           surfaces.reflectances[hit.primitive], rays[i], hit.t, random);
      echoes[i] = {static_cast<std::uint32_t>(i),
                   static_cast<float>(hit.t + noise),
                   intensity,
                   surfaces.mesh.classes[hit.primitive],
                   surfaces.instances[hit.primitive],
                   surfaces.reflectances[hit.primitive]};
    }
  });
  std::erase_if(echoes,
                [](const StreetEcho& echo) { return echo.ray == kMiss || echo.range_m <= 0; });
  return echoes;
}

double StreetCaster::fixed_share(const LidarModel& sensor, std::span<const Firing> firings,
                                 const TimedPose& pose) const {
  const std::vector<Ray> rays = street_rays(sensor, firings, pose.world_from_sensor, executor_);
  std::vector<Hit> hits(rays.size());
  fixed_->nearest(rays, hits, executor_);
  const auto valid = std::ranges::count_if(hits, [](const Hit& hit) { return hit.valid(); });
  return static_cast<double>(valid) / static_cast<double>(std::max<std::size_t>(1, rays.size()));
}

}  // namespace adasplats
