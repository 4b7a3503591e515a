// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/placed_object.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// Added to the radius of every sphere: far above the rounding error of float rays in range.
constexpr double kMargin_m = 1e-2;

std::uint16_t usual_class(std::span<const std::uint16_t> classes) {
  std::map<std::uint16_t, std::size_t> counts;
  for (const std::uint16_t id : classes) ++counts[id];
  const auto most = std::ranges::max_element(
      counts, {}, [](const auto& id_and_count) { return id_and_count.second; });
  return most == counts.end() ? std::uint16_t{0} : most->first;
}

ObjectPose knot_of(const RigidTransform& pose, double share, Vec3d scene_origin) {
  const Mat3d object_from_world = pose.rotation.transposed();
  const Vec3d* const rows = object_from_world.rows;
  return {{rows[0], rows[1], rows[2]}, scene_origin - pose.translation, share};
}

/// Begin, end, and the object's poses in between.
Trajectory poses_between(const PlacedObject& placed, double begin_s, double end_s) {
  const Trajectory& all = placed.object.trajectory;
  Trajectory poses = {{begin_s, placed.world_from_object(begin_s)}};
  auto pose = std::ranges::upper_bound(all, begin_s, {}, &TimedPose::time_s);
  for (; pose != all.end() && pose->time_s < end_s; ++pose) poses.push_back(*pose);
  if (end_s > begin_s) poses.push_back({end_s, placed.world_from_object(end_s)});
  return poses;
}

LocalBox local_box(const WorldBox& box, Vec3d origin) {
  constexpr double kMargin = 1e-3;
  const double margin = kMargin * length(box.size());
  const Vec3d around = {margin, margin, margin};
  return {vec_cast<float>(box.low - origin - around), vec_cast<float>(box.high - origin + around)};
}

WorldSphere sphere_around(const PlacedObject& placed, const Trajectory& poses) {
  const double scale = placed.object.scale;
  const Vec3d center = scale * placed.geometry->box.center();
  const double radius = 0.5 * scale * length(placed.geometry->box.size());
  const RigidTransform* before = &poses.front().world_from_sensor;
  WorldBox path = {*before * center, *before * center};
  double bend = 0;
  for (const TimedPose& pose : poses) {
    path.add(pose.world_from_sensor * center);
    // A rotation moves the centre off the straight line between two poses by less than an eighth of
    // its acceleration, as for any linear interpolation.
    const double turn_rad = angle_between(before->rotation, pose.world_from_sensor.rotation);
    bend = std::max(bend, 0.125 * length(center) * turn_rad * turn_rad);
    before = &pose.world_from_sensor;
  }
  return {path.center(), 0.5 * length(path.size()) + bend + radius + kMargin_m};
}

/// Adds poses so that the object turns by less than half a degree from one to the next.
Trajectory with_small_turns(const PlacedObject& placed, const Trajectory& poses) {
  constexpr double kHalfDegree_rad = 0.5 * std::numbers::pi / 180;
  constexpr double kMaxParts = 64;
  Trajectory fine = {poses.front()};
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const TimedPose &from = poses[k - 1], &to = poses[k];
    const double turn_rad =
        angle_between(from.world_from_sensor.rotation, to.world_from_sensor.rotation);
    const double parts = std::clamp(std::ceil(turn_rad / kHalfDegree_rad), 1.0, kMaxParts);
    for (double part = 1; part < parts; ++part) {
      const double time_s = from.time_s + part / parts * (to.time_s - from.time_s);
      fine.push_back({time_s, placed.world_from_object(time_s)});
    }
    fine.push_back(to);
  }
  return fine;
}

}  // namespace

/// Rays meet objects one by one, each with its nearest hit.
AnyModel with_opaque_disks(AnyModel model) {
  SplatModel* const splats = std::get_if<SplatModel>(&model);
  if (splats == nullptr || splats->opacities.empty()) return model;
  splats->disks = opaque_disks(*splats);
  splats->opacities.clear();
  return model;
}

ObjectGeometry::ObjectGeometry(AnyModel model, std::vector<std::uint16_t> instances_of_primitives)
    : place(with_opaque_disks(std::move(model))),
      instances(std::move(instances_of_primitives)),
      usual_class(adasplats::usual_class(classes_of(place))),
      primitives(static_cast<std::uint32_t>(view_of(place).primitive_count())) {
  if (!instances.empty() && instances.size() != primitives)
    throw std::logic_error("World: one instance a splat is needed");
  std::tie(box.low, box.high) = world_box_of(place);
}

const Tracer& ObjectGeometry::tracer(const Executor& executor) const {
  std::call_once(built_, [&] { tracer_ = make_cpu_tracer(view_of(place), executor); });
  return *tracer_;
}

WorldSphere swept_sphere(const PlacedObject& placed, double begin_s, double end_s) {
  return sphere_around(placed, poses_between(placed, begin_s, end_s));
}

ObjectSighting sighting_of(const PlacedObject& placed, double begin_s, double duration_s,
                           Vec3d scene_origin, std::vector<ObjectPose>& knots) {
  const Trajectory& poses = placed.object.trajectory;
  const Trajectory between = poses_between(placed, begin_s, begin_s + duration_s);
  const WorldSphere sphere = sphere_around(placed, between);
  ObjectSighting sighting;
  sighting.center = sphere.center - scene_origin;
  sighting.radius_m = sphere.radius;
  sighting.geometry_origin = origin_of(placed.geometry->place);
  sighting.box = local_box(placed.geometry->box, sighting.geometry_origin);
  sighting.scale = placed.object.scale;
  sighting.geometry = static_cast<std::uint32_t>(placed.object.geometry);
  sighting.first_primitive = placed.first_primitive;
  sighting.first_knot = static_cast<std::uint32_t>(knots.size());
  if (!placed.moves(duration_s)) {
    knots.push_back(knot_of(between.front().world_from_sensor, 0, scene_origin));
    return sighting;
  }
  if (placed.object.only_during) {
    sighting.first_share = static_cast<float>((poses.front().time_s - begin_s) / duration_s);
    sighting.last_share = static_cast<float>((poses.back().time_s - begin_s) / duration_s);
  }
  for (const TimedPose& pose : with_small_turns(placed, between))
    knots.push_back(
        knot_of(pose.world_from_sensor, (pose.time_s - begin_s) / duration_s, scene_origin));
  sighting.knot_count = static_cast<std::uint32_t>(knots.size()) - sighting.first_knot;
  return sighting;
}

void check_object(const WorldObject& object) {
  const std::string name = object.name.empty() ? "an object" : "object '" + object.name + "'";
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::usage, name + what); };
  if (object.trajectory.empty()) fail(" has no pose");
  if (!(object.scale > 0) || !std::isfinite(object.scale))
    fail(" has scale " + std::to_string(object.scale) + ", expected more than 0");
  for (const TimedPose& pose : object.trajectory) {
    const RigidTransform& placed = pose.world_from_sensor;
    bool finite = std::isfinite(pose.time_s) && is_finite(placed.translation);
    for (const Vec3d& row : placed.rotation.rows) finite = finite && is_finite(row);
    if (!finite) fail(" has a pose that is not finite");
  }
  const auto not_after = [](const TimedPose& a, const TimedPose& b) {
    return b.time_s <= a.time_s;
  };
  if (std::ranges::adjacent_find(object.trajectory, not_after) != object.trajectory.end())
    fail(" has poses whose times do not ascend");
}

}  // namespace adasplats
