// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "adasplats/core/maths/random.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

namespace {

/// What a ray's random numbers are for; each has a stream of its own.
enum class Draw : std::uint64_t { range = 0, angles = 1, drop = 2 };

/// By (seed, scan, firing) and what for. Range noise of a firing's first return has the stream of
/// the scan alone, as it always had.
Random draw(std::uint64_t seed, Draw what, std::uint64_t scan_index, std::size_t firing,
            std::size_t return_index) {
  const std::uint64_t stream =
      scan_index ^ (static_cast<std::uint64_t>(what) << 56 | std::uint64_t{return_index} << 48);
  return {seed, stream, firing};
}

/// A return with the firing that it is of.
struct FiringReturn {
  std::uint32_t firing = 0;
  std::uint8_t index = 0;  ///< among the firing's returns
  Return echo;
};

/// Returns of consecutive firings.
struct ChunkedReturns {
  std::vector<std::vector<FiringReturn>> chunks;
  std::vector<std::size_t> firsts;  ///< number of each chunk's first return among all
  std::size_t count = 0;
};

/// Makes the returns of one scan from its hits, step by step.
class ScanMaker {
 public:
  ScanMaker(const PrimitiveAttributes& attributes, const LidarModel& sensor,
            std::span<const Firing> firings, const ScanMotion& motion, std::uint64_t scan_index,
            const SimulateOptions& options, const Executor& executor)
      : attributes_(attributes),
        sensor_(sensor),
        firings_(firings),
        motion_(motion),
        scan_index_(scan_index),
        options_(options),
        executor_(executor) {}

  /// Chunk by chunk, in their order, so that threads do not show.
  ChunkedReturns returns(std::span<const Hit> hits) const {
    ChunkedReturns returns;
    returns.chunks.resize((firings_.size() + kFineGrain - 1) / kFineGrain);
    executor_.for_chunks(firings_.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
      returns.chunks[begin / kFineGrain] = returns_of_firings(hits, begin, end);
    });
    for (const auto& chunk : returns.chunks) {
      returns.firsts.push_back(returns.count);
      returns.count += chunk.size();
    }
    return returns;
  }

  Scan scan(const ChunkedReturns& returns) const {
    Scan scan;
    scan.world_from_sensor = motion_.reference.world_from_sensor;
    scan.time_s = motion_.reference.time_s;
    scan.rays = firings_.size();
    scan.positions.resize(returns.count);
    scan.ranges_m.resize(returns.count);
    scan.rings.resize(returns.count);
    scan.columns.resize(returns.count);
    scan.times_s.resize(returns.count);
    if (options_.beam.returns > 1) scan.return_indices.resize(returns.count);
    if (!attributes_.classes.empty()) scan.classes.resize(returns.count);
    if (!attributes_.instances.empty()) scan.instances.resize(returns.count);
    if (!attributes_.intensities.empty()) scan.intensities.resize(returns.count);
    executor_.for_chunks(returns.chunks.size(), 1, [&](std::size_t chunk, std::size_t) {
      std::size_t i = returns.firsts[chunk];
      for (const FiringReturn& point : returns.chunks[chunk]) fill(scan, i++, point);
    });
    return scan;
  }

 private:
  std::vector<FiringReturn> returns_of_firings(std::span<const Hit> hits, std::size_t begin,
                                               std::size_t end) const {
    const std::vector<float> weights = sub_ray_weights(options_.beam);
    const std::size_t hits_a_firing = options_.beam.hits_per_firing();
    std::vector<Return> reported(static_cast<std::size_t>(options_.beam.returns));
    std::vector<FiringReturn> found;
    found.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t count = returns_of(hits.subspan(i * hits_a_firing, hits_a_firing), weights,
                                           attributes_.classes, options_.beam, reported);
      std::uint8_t index = 0;
      for (std::size_t k = 0; k < count; ++k) {
        FiringReturn point{static_cast<std::uint32_t>(i), index, reported[k]};
        if (!is_reported(point, k)) continue;
        found.push_back(point);
        ++index;
      }
    }
    return found;
  }

  /// Whether the sensor reports it; measures its range.
  bool is_reported(FiringReturn& point, std::size_t k) const {
    if (options_.ray_drop != nullptr) {
      const double probability =
          options_.ray_drop->probability({point.echo.range_m, cos_incidence(point),
                                          reflectance(point), firings_[point.firing].direction});
      if (draw(options_.seed, Draw::drop, scan_index_, point.firing, k).uniform() < probability)
        return false;
    }
    double range_m = static_cast<double>(point.echo.range_m);
    if (options_.unit_offsets) range_m -= range_offset_m(firings_[point.firing].ring);
    if (options_.noise && sensor_.range_noise_m > 0)
      range_m += sensor_.range_noise_m *
                 draw(options_.seed, Draw::range, scan_index_, point.firing, k).normal();
    if (options_.noise && sensor_.range_resolution_m > 0)
      range_m = sensor_.range_resolution_m * std::round(range_m / sensor_.range_resolution_m);
    point.echo.range_m = static_cast<float>(range_m);
    return point.echo.range_m > static_cast<float>(sensor_.min_range_m) &&
           point.echo.range_m <= static_cast<float>(sensor_.max_range_m);
  }

  double range_offset_m(std::uint16_t ring) const {
    return ring < sensor_.range_offsets_m.size() ? sensor_.range_offsets_m[ring] : 0.0;
  }

  float reflectance(const FiringReturn& point) const {
    return point.echo.primitive < attributes_.intensities.size()
               ? attributes_.intensities[point.echo.primitive]
               : std::numeric_limits<float>::quiet_NaN();
  }

  /// Of the beam and the disk or triangle.
  float cos_incidence(const FiringReturn& point) const {
    const std::uint32_t primitive = point.echo.primitive;
    if (primitive >= attributes_.view.primitive_count()) return 1.0F;
    const Firing& firing = firings_[point.firing];
    const double share = static_cast<double>(firing.time_s) * sensor_.rotation_hz;
    const Vec3d direction = pose_at(motion_, share).rotation * vec_cast<double>(firing.direction);
    Vec3f normal;
    if (primitive < attributes_.view.disk_count()) {
      normal = attributes_.view.disks[primitive].normal;
    } else {
      const Triangle triangle =
          attributes_.view.mesh->triangle(primitive - attributes_.view.disk_count());
      normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
      const float doubled_area = length(normal);
      if (!(doubled_area > 0)) return 1.0F;
      normal = normal / doubled_area;
    }
    return std::min(std::fabs(dot(vec_cast<float>(direction), normal)), 1.0F);
  }

  /// Where the sensor reports the point to be.
  Vec3f position(const FiringReturn& point) const {
    const Firing& firing = firings_[point.firing];
    Vec3f direction = firing.direction;
    if (options_.noise && sensor_.angular_noise_rad > 0) direction = noisy(point);
    const Vec3f there = firing.origin + point.echo.range_m * direction;
    if (options_.frame == PointFrame::raw || motion_.knots.empty()) return there;
    const double share = static_cast<double>(firing.time_s) * sensor_.rotation_hz;
    return vec_cast<float>(motion_.reference.world_from_sensor.inverse() *
                           (pose_at(motion_, share) * vec_cast<double>(there)));
  }

  /// The firing's direction with the error of the angles that the sensor reports.
  Vec3f noisy(const FiringReturn& point) const {
    const Vec3d d = vec_cast<double>(firings_[point.firing].direction);
    Random random = draw(options_.seed, Draw::angles, scan_index_, point.firing, 0);
    const double left = sensor_.angular_noise_rad * random.normal();
    const double up = sensor_.angular_noise_rad * random.normal();
    const double flat = std::hypot(d.x, d.y);
    // Straight up there is no left: any direction will do.
    const Vec3d to_left = flat > 0 ? Vec3d{-d.y / flat, d.x / flat, 0} : Vec3d{0, 1, 0};
    return vec_cast<float>(normalized(d + left * to_left + up * cross(d, to_left)));
  }

  /// Point i of the scan, in every attribute that the scan has.
  void fill(Scan& scan, std::size_t i, const FiringReturn& point) const {
    const Firing& firing = firings_[point.firing];
    scan.positions[i] = position(point);
    scan.ranges_m[i] = point.echo.range_m;
    scan.rings[i] = firing.ring;
    scan.columns[i] = firing.column;
    scan.times_s[i] = firing.time_s;
    if (!scan.return_indices.empty()) scan.return_indices[i] = point.index;
    if (!scan.classes.empty()) scan.classes[i] = value_of(attributes_.classes, point);
    if (!scan.instances.empty()) scan.instances[i] = value_of(attributes_.instances, point);
    if (!scan.intensities.empty()) scan.intensities[i] = intensity(point);
  }

  /// Things without a reflectance, as inserted meshes, send back nothing that could be reported.
  float intensity(const FiringReturn& point) const {
    const float value = value_of(attributes_.intensities, point);
    if (std::isnan(value)) return 0;
    if (attributes_.response == nullptr) return value;
    return value * attributes_.response->gain(point.echo.range_m, cos_incidence(point));
  }

  /// That of the primitive that was hit.
  template <class T>
  static T value_of(std::span<const T> values, const FiringReturn& point) {
    if (point.echo.primitive < values.size()) return values[point.echo.primitive];
    throw std::logic_error("an attribute has fewer values than the scene has primitives");
  }

  const PrimitiveAttributes& attributes_;
  const LidarModel& sensor_;
  std::span<const Firing> firings_;
  const ScanMotion& motion_;
  std::uint64_t scan_index_;
  const SimulateOptions& options_;
  const Executor& executor_;
};

template <class T>
std::vector<T> kept_values(const std::vector<T>& values, std::span<const std::uint8_t> keep) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (keep[i] != 0) kept.push_back(values[i]);
  return kept;
}

}  // namespace

Scan kept_points(const Scan& scan, std::span<const std::uint8_t> keep) {
  if (keep.size() != scan.size()) throw std::logic_error("one flag a point is needed");
  Scan kept;
  kept.world_from_sensor = scan.world_from_sensor;
  kept.time_s = scan.time_s;
  kept.rays = scan.rays;
  kept.positions = kept_values(scan.positions, keep);
  for_each_scan_attribute(
      [&](const auto& attribute) { attribute.of(kept) = kept_values(attribute.of(scan), keep); });
  return kept;
}

std::vector<FiringRay> firing_rays(const LidarModel& sensor, std::span<const Firing> firings) {
  std::vector<FiringRay> rays;
  rays.reserve(firings.size());
  for (const Firing& firing : firings) {
    const double share = static_cast<double>(firing.time_s) * sensor.rotation_hz;
    rays.push_back(
        {firing.direction, static_cast<float>(std::clamp(share, 0.0, 1.0)), firing.origin, 0});
  }
  return rays;
}

std::vector<Ray> scan_rays(const LidarModel& sensor, std::span<const Firing> firings,
                           const ScanMotion& motion, Vec3d scene_origin, const Executor& executor) {
  const std::vector<ScanPose> poses = scan_poses(motion, scene_origin);
  const auto pose_count = static_cast<std::uint32_t>(poses.size());
  const std::vector<FiringRay> from = firing_rays(sensor, firings);
  const auto t_min = static_cast<float>(sensor.min_range_m);
  const auto t_max = static_cast<float>(sensor.max_range_m);
  std::vector<Ray> rays(firings.size());
  executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      rays[i] = scan_ray(poses.data(), pose_count, from[i], t_min, t_max);
  });
  return rays;
}

Scan scan_of_hits(std::span<const Hit> hits, const PrimitiveAttributes& attributes,
                  const LidarModel& sensor, std::span<const Firing> firings,
                  const ScanMotion& motion, std::uint64_t scan_index,
                  const SimulateOptions& options, const Executor& executor) {
  if (hits.size() != firings.size() * options.beam.hits_per_firing())
    throw std::logic_error("a scan needs the hits of every firing's rays");
  const ScanMaker maker(attributes, sensor, firings, motion, scan_index, options, executor);
  return maker.scan(maker.returns(hits));
}

Scan simulate_scan(const Tracer& tracer, const PrimitiveAttributes& attributes, Vec3d scene_origin,
                   const LidarModel& sensor, std::span<const Firing> firings,
                   const ScanMotion& motion, std::uint64_t scan_index,
                   const SimulateOptions& options, const Executor& executor) {
  const std::vector<Firing> cast_firings = sub_firings(sensor, firings, options.beam);
  const std::vector<Ray> rays = scan_rays(sensor, cast_firings, motion, scene_origin, executor);
  std::vector<Hit> hits(firings.size() * options.beam.hits_per_firing());
  tracer.nearest_hits(rays, options.beam.depth, hits, executor);
  return scan_of_hits(hits, attributes, sensor, firings, motion, scan_index, options, executor);
}

}  // namespace adasplats
