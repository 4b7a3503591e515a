// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/simulate/scan/scan_caster.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/simulate/world/object_ray.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {

/// Something that stands or moves in the place, in a frame of its own.
struct WorldObject {
  std::string name;
  /// Which of the world's geometries it is.
  std::size_t geometry = 0;
  /// world_from_object over time; one pose: it stands there. Between poses it moves evenly, before
  /// the first and after the last it stands, or is not there (`only_during`). Objects move during a
  /// scan where the scan does (ScanMotion::knots); a scan that stands still is a snapshot.
  Trajectory trajectory;
  bool only_during = false;
  /// There in this scan alone: the paper's frame number (section "SimKITTI32").
  std::optional<std::uint64_t> only_scan;
  double scale = 1;
  std::optional<std::uint16_t> class_id;  ///< instead of the geometry's classes
  std::uint16_t instance = 0;             ///< 0: the geometry's instances, if it has any
};

/// What an object is made of. `instances`: one a primitive, or empty; with them a geometry is the
/// points of many objects, which has no box.
struct NewGeometry {
  AnyModel place;
  std::vector<std::uint16_t> instances;
};

/// A box around an object, as data sets of objects have it.
struct ObjectBox {
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;
  RigidTransform world_from_box;  ///< the box's centre and axes: x along its length
  Vec3d size_m;                   ///< length, width, height
};

/// Objects in scans, and their poses: ObjectSighting::first_knot is an index of `knots`.
struct ObjectSightings {
  std::vector<ObjectSighting> objects;
  std::vector<ObjectPose> knots;

  void clear() {
    objects.clear();
    knots.clear();
  }
};

/// What moves in a place and what was put there: cast apart from the place itself, object by
/// object, so that its cost is up to the objects that a scan can see, not to those of all other
/// scans.
class World {
 public:
  /// `first_primitive`: of the first object, which is the number of primitives of the place.
  /// `scene_origin`: world coordinates of the place's local origin.
  World(std::uint32_t first_primitive, Vec3d scene_origin);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Geometries are numbered in the order in which they come.
  std::size_t add_geometry(AnyModel geometry, std::vector<std::uint16_t> instances = {});
  /// `count` of them at once, the i-th of made(i), which several threads call; gives the number of
  /// the first.
  std::size_t add_geometries(std::size_t count, FunctionRef<NewGeometry(std::size_t)> made,
                             const Executor& executor);
  /// Errors: usage (no poses, times that do not ascend, a scale that is not positive); data (more
  /// primitives than have numbers); std::logic_error (no such geometry).
  void add_object(WorldObject object);

  /// Gives an object other poses: one that a user takes somewhere else while scans are made. It
  /// stays in the scans that it is in. Not while it is cast. Errors: as add_object(), and
  /// std::logic_error (no such object).
  void move_object(std::size_t object, Trajectory trajectory);

  bool empty() const;
  std::size_t object_count() const;
  const WorldObject& object(std::size_t object) const;
  Vec3d scene_origin() const;

  /// Merges hits of the objects that are there in scan `scan_index` into hits[i * depth + k] of
  /// firing i, ascending, for the poses in which sensor and objects are when it fires. Primitives
  /// of objects have numbers from `first_primitive` on, object after object. `scan_duration_s`: of
  /// a revolution, whose middle is motion.reference. The same bytes for any number of threads.
  /// Throws std::logic_error where there are not `depth` hits a firing.
  void add_hits(std::uint64_t scan_index, const LidarModel& sensor, std::span<const Firing> firings,
                const ScanMotion& motion, double scan_duration_s, int depth, std::span<Hit> hits,
                const Executor& executor) const;

  /// Appends the objects that are there in a scan, in the order in which they were added: what a
  /// device needs to cast them as add_hits() does.
  void sight(std::uint64_t scan_index, const ScanMotion& motion, double scan_duration_s,
             ObjectSightings& all) const;
  std::size_t geometry_count() const;
  SceneView geometry_view(std::size_t geometry) const;
  const AnyModel& geometry(std::size_t geometry) const;
  /// Whether objects that are there in many scans are made of it.
  bool is_in_all_scans(std::size_t geometry) const;
  /// Differs between worlds and changes when geometry or an object is added, so that caches of
  /// derived data can detect that they are out of date.
  std::shared_ptr<const int> identity() const;

  /// What primitives of the place and of the objects carry: `place` continued; views of this world.
  /// What some objects or the place lack is 0 for them (intensities: NaN).
  /// They end with the next call, and with an object that is added. Throws std::logic_error where
  /// the place has values, but not one a primitive.
  PrimitiveAttributes attributes(const PrimitiveAttributes& place);
  /// Those of the objects alone, from the number of the first one on.
  PrimitiveAttributes object_attributes();

  /// Boxes around the objects that are there at `time_s` in scan `scan_index`, in the order in
  /// which they were added. An object without a class of its own has the one that most of its
  /// primitives have.
  std::vector<ObjectBox> boxes(std::uint64_t scan_index, double time_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
