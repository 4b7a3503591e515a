// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// What primitives carry besides their geometry; each is empty or has one value a primitive.
struct PrimitiveAttributes {
  std::span<const std::uint16_t> classes;
  std::span<const std::uint16_t> instances;
  std::span<const float> intensities;
};

/// One revolution of one LiDAR: the rays that returned, in firing order of `firings_of`.
struct Scan {
  RigidTransform world_from_sensor;
  double time_s = 0;
  std::size_t rays = 0;          ///< cast; size() of them returned
  std::vector<Vec3f> positions;  ///< sensor frame, m
  std::vector<float> ranges_m;
  std::vector<float> intensities;        ///< empty where the scene has none
  std::vector<std::uint16_t> classes;    ///< empty where the scene has none
  std::vector<std::uint16_t> instances;  ///< empty where the scene has none
  std::vector<std::uint16_t> rings;
  std::vector<float> times_s;  ///< since the start of the revolution

  std::size_t size() const { return positions.size(); }
};

struct SimulateOptions {
  std::uint64_t seed = 0;   ///< of the range noise; drawn by (seed, scan index, ray index)
  bool range_noise = true;  ///< apply the sensor's range_noise_m
};

/// The rays of one revolution in the frame of a scene whose local origin is `scene_origin`, one a
/// firing, between the sensor's least and greatest range.
std::vector<Ray> scan_rays(const LidarModel& sensor, std::span<const Firing> firings,
                           const RigidTransform& world_from_sensor, Vec3d scene_origin,
                           const Executor& executor);

/// What the sensor measures where its rays met the scene: hits[i] of firings[i], in the sensor's
/// range. Adds its noise and gathers what the primitives carry. `scan_index` names the noise.
/// Throws std::logic_error where there is not one hit a firing, or an attribute has fewer values
/// than the scene has primitives.
Scan scan_of_hits(std::span<const Hit> hits, const PrimitiveAttributes& attributes,
                  const LidarModel& sensor, std::span<const Firing> firings, const TimedPose& pose,
                  std::uint64_t scan_index, const SimulateOptions& options,
                  const Executor& executor);

/// Casts one revolution in a scene whose local origin is `scene_origin`. Paper section "Firing
/// Sequence Simulation": all rays leave from the pose. For many scans see scan_caster.h.
Scan simulate_scan(const Tracer& tracer, const PrimitiveAttributes& attributes, Vec3d scene_origin,
                   const LidarModel& sensor, std::span<const Firing> firings, const TimedPose& pose,
                   std::uint64_t scan_index, const SimulateOptions& options,
                   const Executor& executor);

}  // namespace adasplats
