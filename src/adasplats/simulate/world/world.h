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
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/world/object_ray.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {

/// An object at rest or in motion in the scene, in its own frame.
struct WorldObject {
  std::string name;
  /// Number of its geometry in the world.
  std::size_t geometry = 0;
  /// world_from_object over time; one pose: at rest. Between poses it moves uniformly; before the
  /// first and after the last it is at rest or absent (`only_during`). Objects move during a scan
  /// only if the sensor does (ScanMotion::knots); a scan at rest is a snapshot.
  Trajectory trajectory;
  bool only_during = false;
  bool present = true;  ///< false: not seen (set_present())
  /// Present only in this scan: the paper's frame number (section "SimKITTI32").
  std::optional<std::uint64_t> only_scan;
  double scale = 1;
  std::optional<std::uint16_t> class_id;  ///< instead of the geometry's classes
  std::uint16_t instance = 0;             ///< 0: the geometry's instances, if it has any
};

/// The geometry of an object. `instances`: one per primitive, or empty; with instances, a geometry
/// contains the points of many objects and has no box.
struct NewGeometry {
  AnyModel place;
  std::vector<std::uint16_t> instances;
};

/// A box around an object, as in object data sets.
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

/// Moving and inserted objects of a scene. They are cast separately from the scene, object by
/// object, so the cost depends only on the objects that a scan can see, not on those of other
/// scans.
class World {
 public:
  /// `first_primitive`: of the first object, equal to the number of primitives of the scene.
  /// `scene_origin`: world coordinates of the scene's local origin.
  World(std::uint32_t first_primitive, Vec3d scene_origin);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Adds a geometry; numbers follow the order of the calls.
  std::size_t add_geometry(AnyModel geometry, std::vector<std::uint16_t> instances = {});
  /// Adds `count` geometries, the i-th from made(i), which several threads call; returns the number
  /// of the first.
  std::size_t add_geometries(std::size_t count, FunctionRef<NewGeometry(std::size_t)> made,
                             const Executor& executor);
  /// Errors: usage (no poses, times that do not ascend, a scale that is not positive); data (too
  /// many primitives to number); std::logic_error (no such geometry).
  void add_object(WorldObject object);

  /// Replaces the poses of an object that a user moves between scans; the scans in which it is
  /// present stay the same. Not during casts. Errors: as add_object(), and std::logic_error (no
  /// such object).
  void move_object(std::size_t object, Trajectory trajectory);
  /// Whether scans see an object; true at first. Its primitives keep their numbers. Not during
  /// casts. Errors: std::logic_error (no such object).
  void set_present(std::size_t object, bool present);

  bool empty() const;
  std::size_t object_count() const;
  const WorldObject& object(std::size_t object) const;
  Vec3d scene_origin() const;
  /// The time of the first pose of all objects that move; nothing if none does.
  std::optional<double> motion_begin_s() const;

  /// Merges hits of the objects present in scan `scan_index` into hits[i * depth + k] of firing i,
  /// ascending, for the poses of sensor and objects at the time of the firing. Primitives of
  /// objects are numbered from `first_primitive` on, object by object. `scan_duration_s`: duration
  /// of a revolution centred on motion.reference. The bytes do not depend on the number of threads.
  /// Throws std::logic_error if there are not `depth` hits per firing.
  void add_hits(std::uint64_t scan_index, const LidarModel& sensor, std::span<const Firing> firings,
                const ScanMotion& motion, double scan_duration_s, int depth, std::span<Hit> hits,
                const Executor& executor) const;

  /// The same for report_on_cpu(). The world and the executor must outlive it.
  std::unique_ptr<MoreHits> more_hits(double scan_duration_s, const Executor& executor) const;

  /// Merges the nearest hits of objects into those of rays that were cast at their own times, such
  /// as measured beams: hits[i] of rays[i], relative to the scene's local origin, at times_s[i].
  /// Objects of a single scan are left out. Throws std::logic_error if sizes differ.
  void add_hits(std::span<const Ray> rays, std::span<const double> times_s, std::span<Hit> hits,
                const Executor& executor) const;

  /// The objects present in a scan, near ones first, with the data that a device needs to cast them
  /// like add_hits().
  void sight(std::uint64_t scan_index, const ScanMotion& motion, double scan_duration_s,
             ObjectSightings& seen) const;
  std::size_t geometry_count() const;
  SceneView geometry_view(std::size_t geometry) const;
  const AnyModel& geometry(std::size_t geometry) const;
  /// Whether objects that are present in many scans use this geometry.
  bool is_in_all_scans(std::size_t geometry) const;
  /// Differs between worlds and changes when geometry or an object is added, so that caches of
  /// derived data can detect that they are out of date.
  std::shared_ptr<const int> identity() const;

  /// Attributes of the primitives of the scene (`place`), followed by those of the objects, as
  /// views of this world. Missing attributes are 0 (intensities: NaN). Valid until the next call or
  /// the next added object. Throws std::logic_error if the scene has attributes without a value for
  /// every primitive.
  PrimitiveAttributes attributes(const PrimitiveAttributes& place);
  /// Attributes of the objects only, starting at the first primitive of the objects.
  PrimitiveAttributes object_attributes();

  /// The velocity of the surface at every point of a scan (ScanView::velocities): that of the
  /// object with the point's instance whose box, grown by 0.3 m, contains the point; 0 for others.
  /// The scan needs instances and times.
  std::vector<Vec3f> velocities(std::uint64_t scan_index, const ScanView& scan) const;

  /// Boxes around the objects present at `time_s` in scan `scan_index`, in the order of addition.
  /// An object without its own class has the most frequent class of its primitives.
  std::vector<ObjectBox> boxes(std::uint64_t scan_index, double time_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
