// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/placed_object.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// Added to every sphere: far above what rays of floats are off by within their range.
constexpr double kMargin_m = 1e-2;

std::uint16_t usual_class(std::span<const std::uint16_t> classes) {
  std::map<std::uint16_t, std::size_t> counts;
  for (const std::uint16_t id : classes) ++counts[id];
  const auto most = std::ranges::max_element(
      counts, {}, [](const auto& id_and_count) { return id_and_count.second; });
  return most == counts.end() ? std::uint16_t{0} : most->first;
}

}  // namespace

ObjectGeometry::ObjectGeometry(Place model, std::vector<std::uint16_t> instances_of_primitives,
                               const Executor& executor)
    : place(std::move(model)),
      instances(std::move(instances_of_primitives)),
      tracer(make_cpu_tracer(view_of(place), executor)),
      usual_class(adasplats::usual_class(classes_of(place))),
      primitives(static_cast<std::uint32_t>(view_of(place).primitive_count())) {
  if (!instances.empty() && instances.size() != primitives)
    throw std::logic_error("World: one instance a splat is needed");
  std::tie(box.low, box.high) = world_box_of(place);
}

WorldSphere swept_sphere(const PlacedObject& placed, double begin_s, double end_s) {
  const double scale = placed.object.scale;
  const Vec3d center = scale * placed.geometry->box.center();
  const double radius = 0.5 * scale * length(placed.geometry->box.size());
  RigidTransform before = placed.world_from_object(begin_s);
  WorldBox path = {before * center, before * center};
  double bend = 0;
  const auto go_on = [&](const RigidTransform& pose) {
    path.add(pose * center);
    // Turning takes the centre off the straight line between two poses by less than an eighth of
    // its acceleration, as for any linear interpolation.
    const double turn_rad = angle_between(before.rotation, pose.rotation);
    bend = std::max(bend, 0.125 * length(center) * turn_rad * turn_rad);
    before = pose;
  };
  const Trajectory& poses = placed.object.trajectory;
  auto pose = std::ranges::upper_bound(poses, begin_s, {}, &TimedPose::time_s);
  for (; pose != poses.end() && pose->time_s < end_s; ++pose) go_on(pose->world_from_sensor);
  if (end_s > begin_s) go_on(placed.world_from_object(end_s));
  return {path.center(), 0.5 * length(path.size()) + bend + radius + kMargin_m};
}

void check_object(const WorldObject& object) {
  const std::string name = object.name.empty() ? "an object" : "object '" + object.name + "'";
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::usage, name + what); };
  if (object.trajectory.empty()) fail(" has no pose");
  if (!(object.scale > 0) || !std::isfinite(object.scale))
    fail(" has the scale " + std::to_string(object.scale) + ", expected more than 0");
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
