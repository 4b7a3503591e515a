// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/simulate/scan/scan_reporter.h"

namespace adasplats {

namespace {

template <class T>
std::vector<T> kept_values(const std::vector<T>& values, std::span<const std::uint8_t> keep) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (keep[i] != 0) kept.push_back(values[i]);
  return kept;
}

}  // namespace

std::size_t Scan::size() const {
  std::size_t returns = positions.size();
  for_each_scan_attribute(
      [&](const auto& attribute) { returns = std::max(returns, attribute.of(*this).size()); });
  return returns;
}

ScanFields scan_fields(std::span<const std::string> names) {
  ScanFields fields;
  std::string known = "positions";
  fields.positions = false;
  for_each_scan_attribute([&](const auto& attribute) {
    fields.*attribute.wanted = false;
    known += std::string(", ") + attribute.name;
  });
  for (const std::string& name : names) {
    bool found = name == "positions";
    if (found) fields.positions = true;
    for_each_scan_attribute([&](const auto& attribute) {
      if (name != attribute.name) return;
      found = fields.*attribute.wanted = true;
    });
    if (!found)
      throw Error(ErrorKind::usage, "unknown field '" + name + "', expected some of " + known);
  }
  return fields;
}

Scan kept_points(const Scan& scan, std::span<const std::uint8_t> keep) {
  if (keep.size() != scan.size()) throw std::logic_error("expected one flag per point");
  Scan kept;
  kept.world_from_sensor = scan.world_from_sensor;
  kept.time_s = scan.time_s;
  kept.knots = scan.knots;
  kept.duration_s = scan.duration_s;
  kept.frame = scan.frame;
  kept.rays = scan.rays;
  kept.positions = kept_values(scan.positions, keep);
  for_each_scan_attribute(
      [&](const auto& attribute) { attribute.of(kept) = kept_values(attribute.of(scan), keep); });
  return kept;
}

std::vector<FiringRay> firing_rays(const LidarModel& sensor, std::span<const Firing> firings) {
  std::vector<FiringRay> rays;
  rays.reserve(firings.size());
  for (const Firing& firing : firings) rays.push_back(firing_ray(firing, sensor.rotation_hz));
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
  const ScanRules rules(sensor, {firings.begin(), firings.end()}, options,
                        std::make_shared<PrimitiveTable>(primitive_table(attributes, executor)));
  const std::size_t known = rules.table().values.size();
  for (const Hit& hit : hits)
    if (known > 0 && hit.valid() && hit.primitive >= known)
      throw std::logic_error("an attribute has fewer values than the scene has primitives");
  Scan scan;
  ScanReporter(rules, executor)
      .report(motion, ScanPoses(rules, motion, {}), scan_index, hits, scan);
  return scan;
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
