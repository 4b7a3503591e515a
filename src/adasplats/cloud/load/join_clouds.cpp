// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Clouds of several inputs as one.

#include <algorithm>
#include <string>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"

namespace adasplats {
namespace {

/// Gives every cloud sensor positions if any has them: a point without one has that of its own
/// place and OriginKind::none. Leaves out the kinds where all are measured.
void unify_origins(std::vector<PointCloud>& clouds) {
  const auto has_sensors = [](const PointCloud& c) { return !c.sensor_positions.empty(); };
  const auto all_measured = [](const PointCloud& c) {
    return c.empty() ||
           (!c.sensor_positions.empty() && std::ranges::all_of(c.origin_kinds, [](OriginKind kind) {
             return kind == OriginKind::measured;
           }));
  };
  if (std::ranges::none_of(clouds, has_sensors)) return;
  const bool needs_kinds = !std::ranges::all_of(clouds, all_measured);
  for (PointCloud& cloud : clouds) {
    if (!needs_kinds) {
      cloud.origin_kinds = {};
    } else if (cloud.sensor_positions.empty()) {
      cloud.sensor_positions = cloud.positions;
      cloud.origin_kinds.assign(cloud.size(), OriginKind::none);
    } else if (cloud.origin_kinds.empty()) {
      cloud.origin_kinds.assign(cloud.size(), OriginKind::measured);
    }
  }
}

/// Empties an attribute that some clouds have and others lack.
template <class Attribute>
void unify_attribute(std::vector<PointCloud>& clouds, const Attribute& attribute,
                     ProgressSink& progress) {
  std::size_t with = 0, filled = 0;
  for (const PointCloud& cloud : clouds) {
    if (cloud.empty()) continue;
    ++filled;
    if (!attribute.of(cloud).empty()) ++with;
  }
  if (with == filled) return;
  for (PointCloud& cloud : clouds) attribute.of(cloud) = {};
  if (with != 0)
    progress.warn(std::string(attribute.title) + " dropped: " + std::to_string(with) + " of " +
                  std::to_string(filled) + " inputs have them");
}

}  // namespace

PointCloud joined(std::vector<PointCloud>&& clouds, Vec3d origin, Trajectory scan_poses,
                  ProgressSink& progress) {
  unify_origins(clouds);
  for_each_attribute([&](const auto& attribute) { unify_attribute(clouds, attribute, progress); });
  PointCloud all;
  all.origin = origin;
  for (PointCloud& cloud : clouds)
    if (!cloud.empty()) append(all, std::move(cloud));
  all.scan_poses = std::move(scan_poses);
  return all;
}

}  // namespace adasplats
