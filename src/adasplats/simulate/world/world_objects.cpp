// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/simulate/world/world_file.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {
namespace {

Error object_error(const WorldFile& file, const WorldFileObject& object,
                   const std::string& message) {
  return Error(ErrorKind::config,
               file.path.string() + ":" + std::to_string(object.line) + ": " + message);
}

std::uint16_t class_number(const WorldFile& file, const WorldFileObject& object,
                           const LabelScheme& scheme) {
  if (const auto* const number = std::get_if<std::uint16_t>(&*object.class_id)) return *number;
  const std::string& name = std::get<std::string>(*object.class_id);
  if (const SemanticClass* const found = scheme.find(name)) return found->id;
  std::vector<std::string> names;
  for (const SemanticClass& one : scheme.classes()) names.push_back(one.name);
  const auto nearest = nearest_word(name, names);
  throw object_error(file, object,
                     "the labels '" + scheme.name() + "' have no class '" + name + "'" +
                         (nearest ? ", did you mean '" + *nearest + "'?" : std::string()));
}

/// The poses between two times, with interpolated ones at these.
Trajectory part_of(const Trajectory& whole, double begin_s, double end_s) {
  begin_s = std::max(begin_s, whole.front().time_s);
  end_s = std::min(end_s, whole.back().time_s);
  if (begin_s >= end_s) return {};
  Trajectory part = {{begin_s, interpolate(whole, begin_s)}};
  for (const TimedPose& pose : whole)
    if (pose.time_s > begin_s && pose.time_s < end_s) part.push_back(pose);
  part.push_back({end_s, interpolate(whole, end_s)});
  return part;
}

Trajectory trajectory_of(const WorldFile& file, const WorldFileObject& object) {
  if (object.trajectory.empty()) return {{0.0, object.placement}};
  Trajectory trajectory = read_trajectory(object.trajectory);
  if (object.only_during && trajectory.size() < 2)
    throw object_error(file, object,
                       "present is 'during', but " + object.trajectory.string() + " has one pose");
  const double begin_s = trajectory.front().time_s;
  if (object.only_between_s) {
    trajectory = part_of(trajectory, (*object.only_between_s)[0], (*object.only_between_s)[1]);
    if (trajectory.size() < 2)
      throw object_error(file, object,
                         "present is outside the times of " + object.trajectory.string());
  }
  for (TimedPose& pose : trajectory) {
    pose.world_from_sensor = pose.world_from_sensor * object.placement;
    pose.time_s = begin_s + object.delay_s + (pose.time_s - begin_s) / object.speed_factor;
  }
  return trajectory;
}

}  // namespace

void add_objects(World& world, const WorldFile& file, const LabelScheme& scheme) {
  std::map<std::filesystem::path, std::size_t> geometries;
  for (const WorldFileObject& object : file.objects) {
    WorldObject added;
    added.name = object.name;
    if (object.class_id) added.class_id = class_number(file, object, scheme);
    added.instance = object.instance;
    added.trajectory = trajectory_of(file, object);
    added.only_during = object.only_during;
    added.only_scan = object.only_scan;
    added.scale = object.scale;
    const auto known = geometries.find(object.geometry);
    if (known != geometries.end()) {
      added.geometry = known->second;
    } else {
      added.geometry = world.add_geometry(load_any_model(object.geometry));
      geometries.emplace(object.geometry, added.geometry);
    }
    world.add_object(std::move(added));
  }
}

}  // namespace adasplats
