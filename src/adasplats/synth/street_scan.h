// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/street.h"
#include "adasplats/trace/tracer.h"

// Private to synth/: the path of the scanning vehicle, and the rays of one revolution against a
// street with its movers.

namespace adasplats {

/// The echo of one ray.
struct StreetEcho {
  std::uint32_t ray = 0;  ///< index into the firings
  float range_m = 0;      ///< with noise
  float intensity = 0;    ///< 0..1
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;
  float reflectance = 0;  ///< of the surface, 0..1
};

/// The rays of one revolution in world coordinates.
std::vector<Ray> street_rays(const LidarModel& sensor, std::span<const Firing> firings,
                             const RigidTransform& world_from_sensor, const Executor& executor);

/// Intensity (0..1) from the reflectance, incidence angle and range, with a texture. Both falloffs
/// are mild, since real sensors correct most of them.
float street_intensity(const Triangle& triangle, float reflectance, const Ray& ray, float t,
                       Random& random);

/// Whether a mover with these bounds would collide with a vehicle; all in the mover's frame.
bool collides(Vec3f low, Vec3f high, Vec3d vehicle);

/// The movers that exist at a given time, in world coordinates. Those that would collide with a
/// vehicle at position `vehicle` are omitted.
BuiltMesh movers_at(const Street& street, double time_s, Vec3d vehicle);

/// Casts revolutions into one street. Keeps views of the street.
class StreetCaster {
 public:
  StreetCaster(const Street& street, double range_noise_m, const Executor& executor);

  /// The echoes of one revolution in the order of `firings`. Noise is drawn by (seed, scan, ray).
  std::vector<StreetEcho> cast(const LidarModel& sensor, std::span<const Firing> firings,
                               const TimedPose& pose, std::uint64_t seed, std::uint64_t scan) const;

  /// Share of rays that hit static surfaces.
  double fixed_share(const LidarModel& sensor, std::span<const Firing> firings,
                     const TimedPose& pose) const;

 private:
  const Street& street_;
  double range_noise_m_;
  const Executor& executor_;
  std::unique_ptr<Tracer> fixed_;
};

/// A sensor's true and recorded pose.
struct RecordedPose {
  TimedPose truth;
  TimedPose recorded;
};

/// Sensor mounts; vehicle frame: x forward, z up, origin on the road.
RigidTransform vehicle_from_mapping_sensor();
RigidTransform vehicle_from_driving_sensor();

/// Length of one pass, m: the street without a margin at both ends, or including the turns at both
/// ends.
double drive_length(const Street& street, const StreetScanOptions& options);

/// Poses of a sensor at `count` evenly spaced positions of one pass. Passes alternate in direction,
/// each in its right lane. The recorded pose contains the pass's error: one rotation about the
/// middle of the street and one offset.
std::vector<RecordedPose> poses_of_pass(const Street& street, const StreetScanOptions& options,
                                        int pass, std::size_t count,
                                        const RigidTransform& vehicle_from_sensor);

}  // namespace adasplats
