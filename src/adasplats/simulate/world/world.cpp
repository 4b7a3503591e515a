// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/world.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/simulate/world/object_hits.h"
#include "adasplats/simulate/world/placed_object.h"

namespace adasplats {

namespace {

void sort_by_distance(std::vector<ObjectSighting>& objects, Vec3d from) {
  std::ranges::stable_sort(objects, {}, [from](const ObjectSighting& object) {
    const Vec3d off = object.center - from;
    return dot(off, off);
  });
}

}  // namespace

struct World::Impl {
  std::uint32_t first_primitive;
  Vec3d scene_origin;
  std::vector<std::unique_ptr<ObjectGeometry>> geometries;
  std::vector<bool> lasting;  ///< geometries of objects that are present in several scans
  std::vector<PlacedObject> objects;
  std::shared_ptr<const int> identity = std::make_shared<int>(0);
  std::uint32_t next_primitive;
  std::vector<std::size_t> in_all_scans;  ///< objects
  /// Objects of a single scan, by scan, so those of other scans cost nothing.
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_scan;
  std::vector<std::uint16_t> classes, instances;  ///< of attributes()
  std::vector<float> intensities;

  /// Objects of a scan in the order of addition.
  std::vector<std::size_t> objects_in(std::uint64_t scan_index, double begin_s,
                                      double end_s) const {
    std::vector<std::size_t> found;
    const auto take = [&](std::size_t i) {
      if (objects[i].geometry->primitives > 0 && objects[i].is_there(begin_s, end_s))
        found.push_back(i);
    };
    for (const std::size_t i : in_all_scans) take(i);
    if (const auto here = by_scan.find(scan_index); here != by_scan.end())
      for (const std::size_t i : here->second) take(i);
    std::ranges::sort(found);
    return found;
  }

  /// What is cast of a scan.
  struct Cast {
    ObjectSightings there;
    std::vector<const Tracer*> tracers;

    bool empty() const { return there.objects.empty(); }
    SightedObjects sighted() const { return {there.objects, there.knots, tracers}; }
  };

  /// Adds the tracers of the objects.
  void prepare(Cast& cast, const Executor& executor) const {
    cast.tracers.clear();
    for (const ObjectSighting& object : cast.there.objects)
      cast.tracers.push_back(&geometries[object.geometry]->tracer(executor));
  }

  /// Values of the primitives from `first` on: `place` and then, object by object, what
  /// of(object) appends; empty where both have nothing.
  template <class T, class Of>
  void fill(std::uint32_t first, std::vector<T>& all, std::span<const T> place, T missing,
            Of&& of) const;
  /// Of the primitives from `first` on.
  PrimitiveAttributes fill_all(std::uint32_t first, const PrimitiveAttributes& place);
};

template <class T, class Of>
void World::Impl::fill(std::uint32_t first, std::vector<T>& all, std::span<const T> place,
                       T missing, Of&& of) const {
  if (!place.empty() && place.size() != first_primitive)
    throw std::logic_error("World: an attribute of the scene needs one value per primitive");
  all.clear();
  bool any = !place.empty();
  all.assign(place.begin(), place.end());
  all.resize(next_primitive - first, missing);
  for (const PlacedObject& object : objects) {
    const std::span<T> values =
        std::span(all).subspan(object.first_primitive - first, object.geometry->primitives);
    any |= of(object, values);
  }
  if (!any) all.clear();
}

World::World(std::uint32_t first_primitive, Vec3d scene_origin) : impl_(std::make_unique<Impl>()) {
  impl_->first_primitive = first_primitive;
  impl_->next_primitive = first_primitive;
  impl_->scene_origin = scene_origin;
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

std::size_t World::add_geometry(AnyModel geometry, std::vector<std::uint16_t> instances) {
  impl_->geometries.push_back(
      std::make_unique<ObjectGeometry>(std::move(geometry), std::move(instances)));
  impl_->lasting.push_back(false);
  impl_->identity = std::make_shared<int>(0);
  return impl_->geometries.size() - 1;
}

std::size_t World::add_geometries(std::size_t count, FunctionRef<NewGeometry(std::size_t)> made,
                                  const Executor& executor) {
  std::vector<std::unique_ptr<ObjectGeometry>> added(count);
  executor.for_chunks(count, 1, [&](std::size_t i, std::size_t) {
    NewGeometry geometry = made(i);
    added[i] =
        std::make_unique<ObjectGeometry>(std::move(geometry.place), std::move(geometry.instances));
  });
  const std::size_t first = impl_->geometries.size();
  std::ranges::move(added, std::back_inserter(impl_->geometries));
  impl_->lasting.resize(first + count, false);
  impl_->identity = std::make_shared<int>(0);
  return first;
}

void World::add_object(WorldObject object) {
  if (object.geometry >= impl_->geometries.size())
    throw std::logic_error("World: an object of a geometry that does not exist");
  check_object(object);
  const ObjectGeometry* const geometry = impl_->geometries[object.geometry].get();
  if (geometry->primitives >= Hit::kNone - impl_->next_primitive)
    throw Error(ErrorKind::data, "the world has more than 2^32 - 2 primitives");
  const std::size_t index = impl_->objects.size();
  if (object.only_scan) {
    impl_->by_scan[*object.only_scan].push_back(index);
  } else {
    impl_->in_all_scans.push_back(index);
    impl_->lasting[object.geometry] = true;
  }
  impl_->identity = std::make_shared<int>(0);
  impl_->objects.push_back({std::move(object), geometry, impl_->next_primitive});
  impl_->next_primitive += geometry->primitives;
}

void World::move_object(std::size_t object, Trajectory trajectory) {
  if (object >= impl_->objects.size()) throw std::logic_error("World: no such object");
  WorldObject moved = impl_->objects[object].object;
  moved.trajectory = std::move(trajectory);
  check_object(moved);
  impl_->objects[object].object = std::move(moved);
}

void World::set_present(std::size_t object, bool present) {
  if (object >= impl_->objects.size()) throw std::logic_error("World: no such object");
  impl_->objects[object].object.present = present;
}

bool World::empty() const { return impl_->objects.empty(); }
std::size_t World::object_count() const { return impl_->objects.size(); }
const WorldObject& World::object(std::size_t object) const {
  return impl_->objects.at(object).object;
}
Vec3d World::scene_origin() const { return impl_->scene_origin; }

std::optional<double> World::motion_begin_s() const {
  std::optional<double> begin_s;
  for (const PlacedObject& placed : impl_->objects) {
    const Trajectory& poses = placed.object.trajectory;
    if (poses.size() > 1)
      begin_s = std::min(poses.front().time_s, begin_s.value_or(poses.front().time_s));
  }
  return begin_s;
}

void World::add_hits(std::uint64_t scan_index, const LidarModel& sensor,
                     std::span<const Firing> firings, const ScanMotion& motion,
                     double scan_duration_s, int depth, std::span<Hit> hits,
                     const Executor& executor) const {
  if (depth < 1 || hits.size() != firings.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("World: expected `depth` hits per firing");
  Impl::Cast objects;
  sight(scan_index, motion, scan_duration_s, objects.there);
  if (objects.empty() || firings.empty()) return;
  const std::vector<Ray> rays = scan_rays(sensor, firings, motion, impl_->scene_origin, executor);
  impl_->prepare(objects, executor);
  add_object_hits(rays, firing_rays(sensor, firings), objects.sighted(), depth, hits, executor);
}

std::unique_ptr<MoreHits> World::more_hits(double scan_duration_s, const Executor& executor) const {
  /// The objects of one scan after the other.
  class Objects final : public MoreHits {
   public:
    Objects(const World& world, double scan_duration_s, const Executor& executor)
        : world_(world), scan_duration_s_(scan_duration_s), executor_(executor) {}

    void begin(std::uint64_t scan_index, const ScanMotion& motion) override {
      world_.sight(scan_index, motion, scan_duration_s_, objects_.there);
      world_.impl_->prepare(objects_, executor_);
    }
    void add(std::span<const Ray> rays, std::span<const FiringRay> firings, int depth,
             std::span<Hit> hits) const override {
      if (!objects_.empty())
        add_object_hits(rays, firings, objects_.sighted(), depth, hits, executor_);
    }

   private:
    const World& world_;
    double scan_duration_s_;
    const Executor& executor_;
    Impl::Cast objects_;
  };
  return std::make_unique<Objects>(*this, scan_duration_s, executor);
}

void World::add_hits(std::span<const Ray> rays, std::span<const double> times_s,
                     std::span<Hit> hits, const Executor& executor) const {
  if (rays.size() != times_s.size() || rays.size() != hits.size())
    throw std::logic_error("World: expected a time and a hit per ray");
  if (rays.empty()) return;
  const auto [first, last] = std::ranges::minmax_element(times_s);
  const double begin_s = *first, duration_s = *last - *first;
  std::vector<FiringRay> firings(rays.size());
  for (std::size_t i = 0; duration_s > 0 && i < rays.size(); ++i)
    firings[i].share = static_cast<float>((times_s[i] - begin_s) / duration_s);
  Impl::Cast objects;
  for (const std::size_t i : impl_->in_all_scans) {
    const PlacedObject& placed = impl_->objects[i];
    if (placed.geometry->primitives == 0 || !placed.is_there(begin_s, *last)) continue;
    objects.there.objects.push_back(
        sighting_of(placed, begin_s, duration_s, impl_->scene_origin, objects.there.knots));
  }
  if (objects.empty()) return;
  sort_by_distance(objects.there.objects, vec_cast<double>(rays.front().origin));
  impl_->prepare(objects, executor);
  add_object_hits(rays, firings, objects.sighted(), 1, hits, executor);
}

void World::sight(std::uint64_t scan_index, const ScanMotion& motion, double scan_duration_s,
                  ObjectSightings& seen) const {
  seen.clear();
  const double duration_s = motion.knots.empty() ? 0.0 : std::max(0.0, scan_duration_s);
  const double begin_s = motion.reference.time_s - 0.5 * duration_s;
  for (const std::size_t i : impl_->objects_in(scan_index, begin_s, begin_s + duration_s))
    seen.objects.push_back(
        sighting_of(impl_->objects[i], begin_s, duration_s, impl_->scene_origin, seen.knots));
  sort_by_distance(seen.objects,
                   motion.reference.world_from_sensor.translation - impl_->scene_origin);
}

std::size_t World::geometry_count() const { return impl_->geometries.size(); }
SceneView World::geometry_view(std::size_t geometry) const {
  return view_of(impl_->geometries.at(geometry)->place);
}
const AnyModel& World::geometry(std::size_t geometry) const {
  return impl_->geometries.at(geometry)->place;
}
bool World::is_in_all_scans(std::size_t geometry) const { return impl_->lasting.at(geometry); }
std::shared_ptr<const int> World::identity() const { return impl_->identity; }

PrimitiveAttributes World::Impl::fill_all(std::uint32_t first, const PrimitiveAttributes& place) {
  const auto copy = []<class T>(std::span<const T> from, std::span<T> to) {
    std::ranges::copy(from, to.begin());
    return !from.empty();
  };
  fill<std::uint16_t>(first, classes, place.classes, 0, [&](const auto& placed, auto to) {
    if (!placed.object.class_id) return copy(classes_of(placed.geometry->place), to);
    std::ranges::fill(to, *placed.object.class_id);
    return true;
  });
  fill<std::uint16_t>(first, instances, place.instances, 0, [&](const auto& placed, auto to) {
    if (placed.object.instance == 0)
      return copy(std::span<const std::uint16_t>(placed.geometry->instances), to);
    std::ranges::fill(to, placed.object.instance);
    return true;
  });
  fill<float>(first, intensities, place.intensities, std::numeric_limits<float>::quiet_NaN(),
              [&](const auto& placed, auto to) {
                return copy(intensities_of(placed.geometry->place), to);
              });
  PrimitiveAttributes all = place;
  all.classes = classes;
  all.instances = instances;
  all.intensities = intensities;
  return all;
}

PrimitiveAttributes World::attributes(const PrimitiveAttributes& place) {
  return empty() ? place : impl_->fill_all(0, place);
}

PrimitiveAttributes World::object_attributes() {
  return impl_->fill_all(impl_->first_primitive, {});
}

std::vector<ObjectBox> World::boxes(std::uint64_t scan_index, double time_s) const {
  std::vector<ObjectBox> boxes;
  for (const std::size_t i : impl_->objects_in(scan_index, time_s, time_s)) {
    const PlacedObject& placed = impl_->objects[i];
    const ObjectGeometry& geometry = *placed.geometry;
    if (!geometry.instances.empty()) continue;
    ObjectBox box;
    box.class_id = placed.object.class_id.value_or(geometry.usual_class);
    box.instance = placed.object.instance;
    const RigidTransform pose = placed.world_from_object(time_s);
    box.world_from_box = {pose.rotation, pose * (placed.object.scale * geometry.box.center())};
    box.size_m = placed.object.scale * geometry.box.size();
    boxes.push_back(box);
  }
  return boxes;
}

namespace {

/// The velocity of a point that is fixed to an object, m/s; 0 before its first and after its last
/// pose.
Vec3d velocity_at(const PlacedObject& placed, double time_s, Vec3d point) {
  constexpr double kStep_s = 1e-3;
  const Trajectory& poses = placed.object.trajectory;
  const double begin_s = std::max(time_s - kStep_s, poses.front().time_s);
  const double end_s = std::min(time_s + kStep_s, poses.back().time_s);
  if (!(end_s > begin_s)) return {};
  const Vec3d in_object = placed.world_from_object(time_s).inverse() * point;
  return (1 / (end_s - begin_s)) * (placed.world_from_object(end_s) * in_object -
                                    placed.world_from_object(begin_s) * in_object);
}

/// Whether a point is in the box of an object, or near it: ranges have noise.
bool is_at(const PlacedObject& placed, double time_s, Vec3d point) {
  constexpr double kNear_m = 0.3;
  const Vec3d in_object = placed.world_from_object(time_s).inverse() * point;
  const double scale = placed.object.scale;
  const WorldBox& box = placed.geometry->box;
  for (int axis = 0; axis < 3; ++axis)
    if (in_object[axis] < scale * box.low[axis] - kNear_m ||
        in_object[axis] > scale * box.high[axis] + kNear_m)
      return false;
  return true;
}

}  // namespace

std::vector<Vec3f> World::velocities(std::uint64_t scan_index, const ScanView& scan) const {
  std::vector<Vec3f> velocities(scan.positions.size());
  if (scan.instances.size() != velocities.size()) return velocities;
  const double half_s = 0.5 * scan.duration_s;
  std::multimap<std::uint16_t, const PlacedObject*> moving;
  for (const std::size_t i :
       impl_->objects_in(scan_index, scan.time_s - half_s, scan.time_s + half_s))
    if (const PlacedObject& placed = impl_->objects[i];
        placed.object.trajectory.size() > 1 && placed.object.instance != 0)
      moving.emplace(placed.object.instance, &placed);
  if (moving.empty()) return velocities;
  const Mat3d sensor_from_world = scan.world_from_sensor.rotation.transposed();
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const auto [begin, end] = moving.equal_range(scan.instances[i]);
    if (begin == end) continue;
    const Vec3d point = world_point_of(scan, i);
    const double time_s = time_of_point(scan, i);
    const auto at = std::find_if(
        begin, end, [&](const auto& entry) { return is_at(*entry.second, time_s, point); });
    if (at == end) continue;
    velocities[i] = vec_cast<float>(sensor_from_world * velocity_at(*at->second, time_s, point));
  }
  return velocities;
}

}  // namespace adasplats
