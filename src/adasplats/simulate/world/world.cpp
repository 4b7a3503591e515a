// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::size_t kRaysPerBundle = 64;  // of one ring: 10 degrees of an HDL-64
static_assert(kFineGrain % kRaysPerBundle == 0);
/// Added to every sphere: far above what rays of floats are off by within their range.
constexpr double kMargin_m = 1e-2;

struct Sphere {
  Vec3d center;
  double radius = 0;
};

struct Box {
  Vec3d low;
  Vec3d high;

  Vec3d center() const { return 0.5 * (low + high); }
  Vec3d size() const { return high - low; }
  void add(Vec3d p) {
    low = min(low, p);
    high = max(high, p);
  }
};

/// What objects are made of. It does not move in memory: its tracer keeps views.
struct Geometry {
  explicit Geometry(SplatModel model) : splats(std::move(model)) {}
  explicit Geometry(MeshModel model) : mesh(std::move(model)) {}

  bool is_mesh() const { return !mesh.mesh.triangles.empty(); }
  SceneView view() const { return is_mesh() ? mesh.view() : splats.view(); }
  Vec3d origin() const { return is_mesh() ? mesh.origin : splats.origin; }
  std::span<const std::uint16_t> classes() const {
    return is_mesh() ? mesh.mesh.classes : splats.classes;
  }

  SplatModel splats;
  MeshModel mesh;
  std::vector<std::uint16_t> instances;
  std::unique_ptr<Tracer> tracer;
  Box box;                        ///< in the object's frame, before it is scaled
  std::uint16_t usual_class = 0;  ///< that most primitives have
  std::uint32_t primitives = 0;
};

Box box_of(const SplatModel& splats) {
  const auto [low, high] = bounds(splats);
  return {splats.origin + vec_cast<double>(low), splats.origin + vec_cast<double>(high)};
}

Box box_of(const MeshModel& model) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const auto& corners : model.mesh.triangles)
    for (const std::uint32_t corner : corners)
      box.add(model.origin + vec_cast<double>(model.mesh.vertices[corner]));
  return model.size() > 0 ? box : Box{};
}

std::uint16_t usual_class(std::span<const std::uint16_t> classes) {
  std::map<std::uint16_t, std::size_t> counts;
  for (const std::uint16_t id : classes) ++counts[id];
  const auto most = std::ranges::max_element(
      counts, {}, [](const auto& id_and_count) { return id_and_count.second; });
  return most == counts.end() ? std::uint16_t{0} : most->first;
}

/// An object and the numbers of its primitives in the world.
struct PlacedObject {
  WorldObject object;
  const Geometry* geometry;
  std::uint32_t first_primitive;

  bool is_there(double begin_s, double end_s) const {
    return !object.only_during || (object.trajectory.front().time_s <= end_s &&
                                   object.trajectory.back().time_s >= begin_s);
  }
  RigidTransform world_from_object(double time_s) const {
    return interpolate(object.trajectory, time_s);
  }
};

/// Holds the whole object at every time from begin_s to end_s, world coordinates.
Sphere swept_sphere(const PlacedObject& placed, double begin_s, double end_s) {
  const double scale = placed.object.scale;
  const Vec3d center = scale * placed.geometry->box.center();
  const double radius = 0.5 * scale * length(placed.geometry->box.size());
  RigidTransform before = placed.world_from_object(begin_s);
  Box path = {before * center, before * center};
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

/// A cone around rays that stand side by side: most objects are out of most cones, which saves
/// looking at every ray for every object.
struct RayBundle {
  Sphere origins;
  Vec3d axis;
  double cos_half = -1;  ///< of the angle between the axis and the outermost ray
  double reach_m = 0;

  explicit RayBundle(std::span<const Ray> rays);
  bool may_meet(const Sphere& sphere) const;
};

RayBundle::RayBundle(std::span<const Ray> rays) : reach_m(static_cast<double>(rays[0].t_max)) {
  const Vec3d first = vec_cast<double>(rays[0].origin);
  Box box = {first, first};
  Vec3d sum;
  for (const Ray& ray : rays) {
    box.add(vec_cast<double>(ray.origin));
    sum = sum + vec_cast<double>(ray.direction);
  }
  origins = {box.center(), 0.5 * length(box.size())};
  if (!(length(sum) > 0)) return;  // all around: every sphere may be met
  axis = normalized(sum);
  cos_half = 1;
  for (const Ray& ray : rays)
    cos_half = std::min(cos_half, dot(axis, vec_cast<double>(ray.direction)));
  // Directions have unit length to 2e-7; near 1 that is much of a small angle.
  constexpr double kRounding = 1e-6;
  cos_half -= kRounding;
}

/// Seen from the cone's tip the sphere has the half angle asin(radius / distance); it is out where
/// the angle to its centre is larger than that and the cone's half angle together.
bool RayBundle::may_meet(const Sphere& sphere) const {
  const Vec3d to_center = sphere.center - origins.center;
  const double radius = sphere.radius + origins.radius;
  const double distance = length(to_center);
  if (distance <= radius) return true;
  if (distance - radius > reach_m) return false;
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  if (cos_half <= -cosine) return true;  // the two angles are 180 degrees or more
  const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
  return dot(axis, to_center) >= distance * (cos_half * cosine - sin_half * sine);
}

/// The rays of one scan, relative to the place's local origin, and when they are cast.
struct ScanRays {
  std::vector<Ray> rays;
  std::vector<FiringRay> firings;
  std::vector<RayBundle> bundles;  ///< of kRaysPerBundle
  Vec3d scene_origin;
  double begin_s = 0;
  double duration_s = 0;  ///< 0: a snapshot

  double end_s() const { return begin_s + duration_s; }
  double time_of(std::size_t ray) const {
    return begin_s + static_cast<double>(firings[ray].share) * duration_s;
  }
};

std::vector<RayBundle> bundles_of(std::span<const Ray> rays) {
  std::vector<RayBundle> bundles;
  bundles.reserve(rays.size() / kRaysPerBundle + 1);
  for (std::size_t first = 0; first < rays.size(); first += kRaysPerBundle)
    bundles.emplace_back(rays.subspan(first, std::min(kRaysPerBundle, rays.size() - first)));
  return bundles;
}

/// Where a ray comes into a sphere, m, not below 0; infinite where it does not within its length.
double entry_m(const Ray& ray, const Sphere& sphere) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Vec3d to_center = sphere.center - vec_cast<double>(ray.origin);
  const double along = dot(to_center, vec_cast<double>(ray.direction));
  const double squared_half =
      sphere.radius * sphere.radius - (dot(to_center, to_center) - along * along);
  if (!(squared_half >= 0)) return kNever;
  const double half = std::sqrt(squared_half);
  if (along + half < 0 || along - half > static_cast<double>(ray.t_max)) return kNever;
  return std::max(0.0, along - half);
}

/// The rays that may meet one object, in its own frame and unit. They begin where they come near
/// it, so that objects in millimetres, say, do not ask for more digits than floats have.
struct ObjectRays {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> firings;
  std::vector<double> begins_m;

  void append(const ObjectRays& other) {
    rays.insert(rays.end(), other.rays.begin(), other.rays.end());
    firings.insert(firings.end(), other.firings.begin(), other.firings.end());
    begins_m.insert(begins_m.end(), other.begins_m.begin(), other.begins_m.end());
  }
};

Ray ray_in_object(const Ray& ray, double begin_m, Vec3d scene_origin, const PlacedObject& placed,
                  const RigidTransform& world_from_object) {
  const double scale = placed.object.scale;
  const Mat3d object_from_world = world_from_object.rotation.transposed();
  const Vec3d direction = vec_cast<double>(ray.direction);
  const Vec3d begin = vec_cast<double>(ray.origin) + begin_m * direction;
  const Vec3d from_object = (scene_origin - world_from_object.translation) + begin;
  const Vec3d origin = (object_from_world * from_object) / scale - placed.geometry->origin();
  const auto in_object = [&](float t) {
    return static_cast<float>((static_cast<double>(t) - begin_m) / scale);
  };
  return {vec_cast<float>(origin), std::max(0.0F, in_object(ray.t_min)),
          vec_cast<float>(object_from_world * direction), in_object(ray.t_max)};
}

ObjectRays rays_in_object(const ScanRays& scan, const PlacedObject& placed, const Sphere& sphere,
                          const Executor& executor) {
  const Sphere local = {sphere.center - scan.scene_origin, sphere.radius};
  const bool moves = scan.duration_s > 0 && placed.object.trajectory.size() > 1;
  const RigidTransform standing = placed.world_from_object(scan.begin_s);
  const auto take = [&](std::size_t i, ObjectRays& part) {
    const double begin_m = entry_m(scan.rays[i], local);
    if (!std::isfinite(begin_m)) return;
    if (moves && !placed.is_there(scan.time_of(i), scan.time_of(i))) return;
    const RigidTransform pose = moves ? placed.world_from_object(scan.time_of(i)) : standing;
    part.rays.push_back(ray_in_object(scan.rays[i], begin_m, scan.scene_origin, placed, pose));
    part.firings.push_back(static_cast<std::uint32_t>(i));
    part.begins_m.push_back(begin_m);
  };
  std::vector<ObjectRays> parts((scan.rays.size() + kFineGrain - 1) / kFineGrain);
  executor.for_chunks(scan.rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    ObjectRays& part = parts[begin / kFineGrain];
    for (std::size_t first = begin; first < end; first += kRaysPerBundle) {
      if (!scan.bundles[first / kRaysPerBundle].may_meet(local)) continue;
      const std::size_t behind = std::min(end, first + kRaysPerBundle);
      for (std::size_t i = first; i < behind; ++i) take(i, part);
    }
  });
  ObjectRays all;
  for (const ObjectRays& part : parts) all.append(part);
  return all;
}

/// Brings hits in an object's frame to the ray of the scan; those that leave its range by rounding
/// are none. `found` is in ascending order again.
void to_scan(std::span<Hit> found, const Ray& ray, double begin_m, const PlacedObject& placed) {
  for (Hit& hit : found) {
    if (!hit.valid()) continue;
    const auto t = static_cast<float>(begin_m + placed.object.scale * static_cast<double>(hit.t));
    const bool in_range = t > ray.t_min && t <= ray.t_max;
    hit = in_range ? Hit{t, placed.first_primitive + hit.primitive} : Hit{};
  }
  // Different distances in the object may be one in the world.
  std::sort(found.begin(), found.end());
}

/// The nearest of both go to `hits`; both ascend.
void merge_nearest(std::span<Hit> hits, std::span<const Hit> found, std::vector<Hit>& buffer) {
  buffer.resize(hits.size() + found.size());
  std::merge(hits.begin(), hits.end(), found.begin(), found.end(), buffer.begin());
  std::copy_n(buffer.begin(), hits.size(), hits.begin());
}

void add_object_hits(const ScanRays& scan, const PlacedObject& placed, const Sphere& sphere,
                     int depth, std::span<Hit> hits, const Executor& executor) {
  const ObjectRays local = rays_in_object(scan, placed, sphere, executor);
  if (local.rays.empty()) return;
  const auto slots = static_cast<std::size_t>(depth);
  std::vector<Hit> found(local.rays.size() * slots);
  if (depth == 1) {
    placed.geometry->tracer->nearest(local.rays, found, executor);
  } else {
    placed.geometry->tracer->nearest_hits(local.rays, depth, found, executor);
  }
  executor.for_chunks(local.rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Hit> buffer;
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<Hit> of_ray = std::span(found).subspan(i * slots, slots);
      if (!of_ray.front().valid()) continue;
      const std::size_t firing = local.firings[i];
      to_scan(of_ray, scan.rays[firing], local.begins_m[i], placed);
      merge_nearest(hits.subspan(firing * slots, slots), of_ray, buffer);
    }
  });
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

}  // namespace

struct World::Impl {
  std::uint32_t first_primitive;
  Vec3d scene_origin;
  const Executor* executor;
  std::vector<std::unique_ptr<Geometry>> geometries;
  std::vector<PlacedObject> objects;
  std::uint32_t next_primitive;
  std::vector<std::size_t> in_all_scans;  ///< objects
  /// Objects of one scan: what other scans have costs nothing.
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_scan;
  std::vector<std::uint16_t> classes, instances;  ///< of attributes()
  std::vector<float> intensities;

  std::size_t add(std::unique_ptr<Geometry> geometry) {
    geometry->primitives = static_cast<std::uint32_t>(geometry->view().primitive_count());
    geometry->usual_class = usual_class(geometry->classes());
    geometry->tracer = make_cpu_tracer(geometry->view(), *executor);
    geometries.push_back(std::move(geometry));
    return geometries.size() - 1;
  }

  /// Objects of a scan in the order in which they were added.
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

  /// `place` and then, object by object, what of(object) appends; empty where both have nothing.
  template <class T, class Of>
  void fill(std::vector<T>& all, std::span<const T> place, T missing, Of&& of) const;
};

template <class T, class Of>
void World::Impl::fill(std::vector<T>& all, std::span<const T> place, T missing, Of&& of) const {
  if (!place.empty() && place.size() != first_primitive)
    throw std::logic_error("World: an attribute of the place needs one value a primitive");
  all.clear();
  bool any = !place.empty();
  all.assign(place.begin(), place.end());
  all.resize(next_primitive, missing);
  for (const PlacedObject& object : objects) {
    const std::span<T> values =
        std::span(all).subspan(object.first_primitive, object.geometry->primitives);
    any |= of(object, values);
  }
  if (!any) all.clear();
}

World::World(std::uint32_t first_primitive, Vec3d scene_origin, const Executor& executor)
    : impl_(std::make_unique<Impl>()) {
  impl_->first_primitive = first_primitive;
  impl_->next_primitive = first_primitive;
  impl_->scene_origin = scene_origin;
  impl_->executor = &executor;
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

std::size_t World::add_geometry(SplatModel splats, std::vector<std::uint16_t> instances) {
  if (!instances.empty() && instances.size() != splats.size())
    throw std::logic_error("World: one instance a splat is needed");
  auto geometry = std::make_unique<Geometry>(std::move(splats));
  geometry->box = box_of(geometry->splats);
  geometry->instances = std::move(instances);
  return impl_->add(std::move(geometry));
}

std::size_t World::add_geometry(MeshModel mesh) {
  auto geometry = std::make_unique<Geometry>(std::move(mesh));
  geometry->box = box_of(geometry->mesh);
  return impl_->add(std::move(geometry));
}

void World::add_object(WorldObject object) {
  if (object.geometry >= impl_->geometries.size())
    throw std::logic_error("World: an object of a geometry that is not there");
  check_object(object);
  const Geometry* const geometry = impl_->geometries[object.geometry].get();
  if (geometry->primitives >= Hit::kNone - impl_->next_primitive)
    throw Error(ErrorKind::data, "the world has more than 2^32 - 2 primitives");
  const std::size_t index = impl_->objects.size();
  if (object.only_scan) {
    impl_->by_scan[*object.only_scan].push_back(index);
  } else {
    impl_->in_all_scans.push_back(index);
  }
  impl_->objects.push_back({std::move(object), geometry, impl_->next_primitive});
  impl_->next_primitive += geometry->primitives;
}

bool World::empty() const { return impl_->objects.empty(); }
std::size_t World::object_count() const { return impl_->objects.size(); }

void World::add_hits(std::uint64_t scan_index, const LidarModel& sensor,
                     std::span<const Firing> firings, const ScanMotion& motion,
                     double scan_duration_s, int depth, std::span<Hit> hits,
                     const Executor& executor) const {
  if (depth < 1 || hits.size() != firings.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("World: `depth` hits a firing are needed");
  ScanRays scan;
  scan.scene_origin = impl_->scene_origin;
  scan.duration_s = motion.knots.empty() ? 0.0 : std::max(0.0, scan_duration_s);
  scan.begin_s = motion.reference.time_s - 0.5 * scan.duration_s;
  const std::vector<std::size_t> there = impl_->objects_in(scan_index, scan.begin_s, scan.end_s());
  if (there.empty() || firings.empty()) return;
  scan.rays = scan_rays(sensor, firings, motion, impl_->scene_origin, executor);
  scan.firings = firing_rays(sensor, firings);
  scan.bundles = bundles_of(scan.rays);
  for (const std::size_t i : there) {
    const PlacedObject& placed = impl_->objects[i];
    const Sphere sphere = swept_sphere(placed, scan.begin_s, scan.end_s());
    add_object_hits(scan, placed, sphere, depth, hits, executor);
  }
}

PrimitiveAttributes World::attributes(const PrimitiveAttributes& place) {
  if (empty()) return place;
  const auto copy = []<class T>(std::span<const T> from, std::span<T> to) {
    std::ranges::copy(from, to.begin());
    return !from.empty();
  };
  impl_->fill<std::uint16_t>(impl_->classes, place.classes, 0, [&](const auto& placed, auto to) {
    if (!placed.object.class_id) return copy(placed.geometry->classes(), to);
    std::ranges::fill(to, *placed.object.class_id);
    return true;
  });
  impl_->fill<std::uint16_t>(
      impl_->instances, place.instances, 0, [&](const auto& placed, auto to) {
        if (placed.object.instance == 0)
          return copy(std::span<const std::uint16_t>(placed.geometry->instances), to);
        std::ranges::fill(to, placed.object.instance);
        return true;
      });
  impl_->fill<float>(impl_->intensities, place.intensities, std::numeric_limits<float>::quiet_NaN(),
                     [&](const auto& placed, auto to) {
                       return copy(std::span<const float>(placed.geometry->splats.intensities), to);
                     });
  PrimitiveAttributes all = place;
  all.classes = impl_->classes;
  all.instances = impl_->instances;
  all.intensities = impl_->intensities;
  return all;
}

std::vector<ObjectBox> World::boxes(std::uint64_t scan_index, double time_s) const {
  std::vector<ObjectBox> boxes;
  for (const std::size_t i : impl_->objects_in(scan_index, time_s, time_s)) {
    const PlacedObject& placed = impl_->objects[i];
    const Geometry& geometry = *placed.geometry;
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

class WorldCaster final : public ScanCaster {
 public:
  WorldCaster(const ScanCaster& place, const World& world, const Executor& executor,
              std::uint64_t first_scan)
      : place_(place), world_(world), executor_(executor), first_scan_(first_scan) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    double added_s = 0;
    std::vector<Hit> all;
    const auto add = [&](std::size_t scan, std::span<const Hit> hits) {
      const auto start = std::chrono::steady_clock::now();
      all.assign(hits.begin(), hits.end());
      world_.add_hits(first_scan_ + scan, sensor, firings, scans[scan], 1.0 / sensor.rotation_hz,
                      depth, all, executor_);
      added_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      sink(scan, all);
    };
    CastTimes times = place_.cast(sensor, firings, scans, depth, add);
    times.traced_s += added_s;
    times.returned_s += added_s;
    return times;
  }

 private:
  const ScanCaster& place_;
  const World& world_;
  const Executor& executor_;
  std::uint64_t first_scan_;
};

}  // namespace

std::unique_ptr<ScanCaster> make_world_caster(const ScanCaster& place, const World& world,
                                              const Executor& executor, std::uint64_t first_scan) {
  return std::make_unique<WorldCaster>(place, world, executor, first_scan);
}

}  // namespace adasplats
