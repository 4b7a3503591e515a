// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/join_clouds.h"

#include <algorithm>
#include <string>
#include <utility>

namespace adasplats {
namespace {

/// If any cloud has sensor positions, gives all of them some: a point without one gets its own
/// position and OriginKind::none. Removes the kinds if all are measured.
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
    progress.warn(std::string(attribute.title) + " are dropped: only " + std::to_string(with) +
                  " of " + std::to_string(filled) + " inputs have them");
}

/// Gives all clouds the same other columns, in one order: those that all of them have. Columns of
/// several types become doubles.
void unify_other_columns(std::vector<PointCloud>& clouds, ProgressSink& progress) {
  std::vector<PointCloud*> filled;
  for (PointCloud& cloud : clouds)
    if (!cloud.empty()) filled.push_back(&cloud);
  const auto find = [](PointCloud& cloud, const std::string& name) {
    return std::ranges::find(cloud.others.columns, name, &Column::name);
  };
  std::vector<std::string> names;
  for (PointCloud* const cloud : filled)
    for (const Column& column : cloud->others.columns)
      if (std::ranges::find(names, column.name) == names.end()) names.push_back(column.name);
  std::vector<std::vector<Column>> unified(filled.size());
  std::string dropped;
  for (const std::string& name : names) {
    bool have_all = true, are_alike = true;
    for (PointCloud* const cloud : filled) {
      const auto column = find(*cloud, name);
      have_all = have_all && column != cloud->others.columns.end();
      are_alike =
          have_all && are_alike && column->values.index() == find(*filled[0], name)->values.index();
    }
    if (!have_all) {
      dropped += (dropped.empty() ? "" : ", ") + name;
      continue;
    }
    for (std::size_t k = 0; k < filled.size(); ++k) {
      Column& column = *find(*filled[k], name);
      if (!are_alike) {
        std::vector<double> values(column.size());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = column.as_double(i);
        column.values = std::move(values);
      }
      unified[k].push_back(std::move(column));
    }
  }
  for (std::size_t k = 0; k < filled.size(); ++k) filled[k]->others.columns = std::move(unified[k]);
  if (!dropped.empty())
    progress.warn("columns that only some of the inputs have are dropped: " + dropped);
}

/// A sensor whose lasers are unknown does not take those of the others away.
void unify_lasers(std::vector<PointCloud>& clouds) {
  const auto has_lasers = [](const PointCloud& cloud) { return !cloud.lasers.empty(); };
  if (std::ranges::none_of(clouds, has_lasers)) return;
  for (PointCloud& cloud : clouds) cloud.lasers.resize(cloud.size(), kNoLaser);
}

}  // namespace

void move_origin(PointCloud& cloud, Vec3d origin) {
  if (cloud.origin == origin) return;
  const auto moved = [by = cloud.origin - origin](Vec3f position) {
    return vec_cast<float>(vec_cast<double>(position) + by);
  };
  for (std::vector<Vec3f>* positions : {&cloud.positions, &cloud.sensor_positions})
    for (Vec3f& position : *positions) position = moved(position);
  for (EmptyBeam& beam : cloud.empty_beams) beam.origin = moved(beam.origin);
  cloud.origin = origin;
}

PointCloud join_clouds(std::vector<PointCloud>&& clouds, Vec3d origin, Trajectory scan_poses,
                       ProgressSink& progress) {
  unify_origins(clouds);
  for_each_attribute([&](const auto& attribute) { unify_attribute(clouds, attribute, progress); });
  unify_other_columns(clouds, progress);
  PointCloud all;
  all.origin = origin;
  for (PointCloud& cloud : clouds)
    if (!cloud.empty()) append(all, std::move(cloud));
  all.scan_poses = std::move(scan_poses);
  return all;
}

PointCloud join_sensors(std::vector<PointCloud>&& clouds, std::vector<CloudSensor> sensors,
                        ProgressSink& progress) {
  const Vec3d origin = clouds.front().origin;
  Trajectory poses;
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    PointCloud& cloud = clouds[k];
    const auto scans = static_cast<std::uint32_t>(poses.size());
    sensors[k].scans = cloud.scan_poses.size();
    for (std::uint32_t& scan : cloud.scan_indices) scan += scans;
    for (EmptyBeam& beam : cloud.empty_beams) beam.scan += scans;
    poses.insert(poses.end(), cloud.scan_poses.begin(), cloud.scan_poses.end());
    move_origin(cloud, origin);
  }
  unify_lasers(clouds);
  PointCloud whole = join_clouds(std::move(clouds), origin, std::move(poses), progress);
  whole.sensors = std::move(sensors);
  return whole;
}

}  // namespace adasplats
