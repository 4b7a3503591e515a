// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Pose of an object at one time of a scan.
struct ObjectPose {
  Vec3d rows[3];     ///< of the rotation, object from world
  Vec3d offset;      ///< from the object to the scene's local origin, world axes, m
  double share = 0;  ///< elapsed share of the revolution
};

/// A box around a geometry in its own frame and unit, with a margin for rounding.
struct LocalBox {
  Vec3f low, high;

  /// Whether a ray meets it.
  ADASPLATS_HD bool is_met(const Ray& ray) const {
    float enter = 0, leave = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
      // A direction of 0 gives infinities, and NaN in the plane of a face, outside the geometry.
      const float inverse = 1 / ray.direction[axis];
      const float a = (low[axis] - ray.origin[axis]) * inverse;
      const float b = (high[axis] - ray.origin[axis]) * inverse;
      const float first = b < a ? b : a, last = a < b ? b : a;
      if (first > enter) enter = first;
      if (last < leave) leave = last;
    }
    return enter <= leave;
  }
};

/// An object in one scan, with all data for its rays and hits, for CPU and GPU.
struct ObjectSighting {
  Vec3d center;           ///< of a sphere that contains it during the scan, relative to the scene's
  double radius_m = 0;    ///< local origin, m
  Vec3d geometry_origin;  ///< of its geometry's local frame, in the object's
  LocalBox box;           ///< around its geometry
  double scale = 1;       ///< m per unit of the geometry
  float first_share = 0;  ///< share of the revolution at which it appears...
  float last_share = 1;   ///< ...and disappears
  std::uint32_t geometry = 0;
  std::uint32_t first_primitive = 0;  ///< in the world
  std::uint32_t first_knot = 0;       ///< its poses by ascending shares: in ObjectSightings
  std::uint32_t knot_count = 1;       ///< one: at rest
};

/// A ray in the frame and unit of an object's geometry. It begins near the object, so the precision
/// of floats suffices, for example, for objects in millimetres.
struct ObjectRay {
  Ray ray;
  double begin_m = 0;  ///< distance along the scan's ray at which this ray begins
};

/// Distance at which a ray enters a sphere, m, at least 0; negative if it does not within its
/// length.
ADASPLATS_HD inline double entry_m(const Ray& ray, Vec3d center, double radius_m) {
  constexpr double kNever = -1;
  const Vec3d to_center = center - vec_cast<double>(ray.origin);
  const double along = dot(to_center, vec_cast<double>(ray.direction));
  const double squared_half = radius_m * radius_m - (dot(to_center, to_center) - along * along);
  if (!(squared_half >= 0)) return kNever;
  const double half = std::sqrt(squared_half);
  if (along + half < 0 || along - half > static_cast<double>(ray.t_max)) return kNever;
  return along - half > 0 ? along - half : 0;
}

inline ADASPLATS_HD Vec3d turned(const ObjectPose& pose, Vec3d v) {
  return {dot(pose.rows[0], v), dot(pose.rows[1], v), dot(pose.rows[2], v)};
}

/// Converts a distance along the scan's ray to the unit of the geometry, from the begin of the
/// object's ray.
ADASPLATS_HD inline double in_object(double t_m, double begin_m, double scale) {
  return (t_m - begin_m) / scale;
}

/// Search distance in an object for hits within `reach_m` of the scan's ray, in the unit of its
/// geometry, with a margin for rounding.
ADASPLATS_HD inline float object_reach(double reach_m, double begin_m, double scale) {
  constexpr double kMargin = 1e-3;
  const double reach = in_object(reach_m, begin_m, scale);
  return static_cast<float>(reach + kMargin * (std::fabs(reach) + 1 / scale));
}

/// The index of the segment at `share`: the last of `count` (at least two) knots that has a
/// successor and is not after `share`; the first if all are after it.
ADASPLATS_HD inline std::uint32_t segment_of(const ObjectPose* knots, std::uint32_t count,
                                             double share) {
  std::uint32_t first = 0, behind = count - 1;
  while (behind - first > 1) {
    const std::uint32_t middle = (first + behind) / 2;
    (knots[middle].share <= share ? first : behind) = middle;
  }
  return first;
}

/// The ray of a firing that may hit an object within `reach_m`, the same on every backend. `ray`:
/// relative to the scene's local origin; `share`: of the revolution at the firing. Between knots,
/// at most half a degree apart, origins and directions are interpolated linearly, like those of the
/// sensor. False: it misses.
ADASPLATS_HD inline bool object_ray(const ObjectSighting& object, const ObjectPose* all_knots,
                                    const Ray& ray, float share, double reach_m, ObjectRay& made) {
  const double begin_m = entry_m(ray, object.center, object.radius_m);
  if (begin_m < 0 || begin_m > reach_m || share < object.first_share || share > object.last_share)
    return false;
  const Vec3d direction = vec_cast<double>(ray.direction);
  const Vec3d begin = vec_cast<double>(ray.origin) + begin_m * direction;
  const ObjectPose* const knots = all_knots + object.first_knot;
  Vec3d from_object, along;
  if (object.knot_count < 2) {
    from_object = turned(knots[0], knots[0].offset + begin);
    along = turned(knots[0], direction);
  } else {
    const std::uint32_t segment = segment_of(knots, object.knot_count, static_cast<double>(share));
    const ObjectPose& from = knots[segment];
    const ObjectPose& to = knots[segment + 1];
    const double late = (static_cast<double>(share) - from.share) / (to.share - from.share);
    const auto mixed = [late](Vec3d a, Vec3d b) { return (1 - late) * a + late * b; };
    const Vec3d there = mixed(from.offset, to.offset) + begin;
    from_object = mixed(turned(from, there), turned(to, there));
    along = normalized(mixed(turned(from, direction), turned(to, direction)));
  }
  const Vec3d origin = from_object / object.scale - object.geometry_origin;
  const auto least =
      static_cast<float>(in_object(static_cast<double>(ray.t_min), begin_m, object.scale));
  auto most = static_cast<float>(in_object(static_cast<double>(ray.t_max), begin_m, object.scale));
  const float reach = object_reach(reach_m, begin_m, object.scale);
  if (reach < most) most = reach;
  made = {{vec_cast<float>(origin), least > 0.0F ? least : 0.0F, vec_cast<float>(along), most},
          begin_m};
  return object.box.is_met(made.ray);
}

/// Converts a hit of an object's ray to one of the scan's ray; none if rounding moves it out of
/// range.
ADASPLATS_HD inline Hit scan_hit(Hit found, const ObjectSighting& object, double begin_m,
                                 const Ray& ray) {
  if (!found.valid()) return {};
  const auto t = static_cast<float>(begin_m + object.scale * static_cast<double>(found.t));
  const bool in_range = t > ray.t_min && t <= ray.t_max;
  return in_range ? Hit{t, object.first_primitive + found.primitive} : Hit{};
}

}  // namespace adasplats
