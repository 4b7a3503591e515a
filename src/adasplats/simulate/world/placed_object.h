// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/simulate/world/object_ray.h"
#include "adasplats/simulate/world/world.h"
#include "adasplats/splats/model/any_model.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

struct WorldSphere {
  Vec3d center;
  double radius = 0;
};

struct WorldBox {
  Vec3d low;
  Vec3d high;

  Vec3d center() const { return 0.5 * (low + high); }
  Vec3d size() const { return high - low; }
  void add(Vec3d p) {
    low = min(low, p);
    high = max(high, p);
  }
};

/// Geometry of objects. Its address must not change because its tracer keeps views of it.
struct ObjectGeometry {
  /// `instances`: one per primitive, or empty.
  ObjectGeometry(AnyModel model, std::vector<std::uint16_t> instances);

  /// Built on first use; never used on a GPU.
  const Tracer& tracer(const Executor& executor) const;

  AnyModel place;
  std::vector<std::uint16_t> instances;
  WorldBox box;               ///< in the object's frame, before it is scaled
  std::uint16_t usual_class;  ///< the most frequent class of its primitives
  std::uint32_t primitives;

 private:
  mutable std::once_flag built_;
  mutable std::unique_ptr<Tracer> tracer_;
};

/// An object and its primitive numbers in the world.
struct PlacedObject {
  WorldObject object;
  const ObjectGeometry* geometry;
  std::uint32_t first_primitive;

  bool is_there(double begin_s, double end_s) const {
    return object.present && (!object.only_during || (object.trajectory.front().time_s <= end_s &&
                                                      object.trajectory.back().time_s >= begin_s));
  }
  RigidTransform world_from_object(double time_s) const {
    return interpolate(object.trajectory, time_s);
  }
  /// Whether it moves during a scan of this duration.
  bool moves(double duration_s) const { return duration_s > 0 && object.trajectory.size() > 1; }
};

/// A sphere that contains the object at every time from begin_s to end_s, world coordinates.
WorldSphere swept_sphere(const PlacedObject& placed, double begin_s, double end_s);

/// The object in a scan that begins at begin_s; duration_s 0: a snapshot. Appends its poses to
/// `knots`.
ObjectSighting sighting_of(const PlacedObject& placed, double begin_s, double duration_s,
                           Vec3d scene_origin, std::vector<ObjectPose>& knots);

/// Errors: those of World::add_object().
void check_object(const WorldObject& object);

}  // namespace adasplats
