// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/live_rig.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

/// Most objects at a time.
constexpr std::size_t kMaxObjects = 10'000;

/// Errors: usage (an axis that turns away from where it was, as of a quaternion in another order).
void require_upright(const UniformMotion& motion, const RigidTransform& before) {
  constexpr double kLeastCosine = 0.17;  // of 80 degrees
  const Vec3d up{0, 0, 1};
  if (dot(motion.from.world_from_sensor.rotation * up, before.rotation * up) < kLeastCosine)
    throw Error(ErrorKind::usage,
                "pose: turns the z axis by more than 80 degrees from where it was; the order is "
                "x, y, z, qx, qy, qz, qw");
}

double turn_of(const MountedSensor& sensor) { return 1 / sensor.settings.sensor.rotation_hz; }

std::size_t scans_in(double step_s, const MountedSensor& sensor) {
  constexpr double kTolerance = 1e-6;
  const double scans = step_s / turn_of(sensor);
  if (std::fabs(scans - std::round(scans)) > kTolerance)
    throw Error(ErrorKind::usage,
                "sensor '" + sensor.name + "' turns " +
                    std::to_string(sensor.settings.sensor.rotation_hz) +
                    " times a second, which is no multiple of the slowest sensor's rate; set "
                    "another --rotation-rate");
  return static_cast<std::size_t>(std::lround(scans));
}

}  // namespace

LiveRig::LiveRig(ModelScene& scene, std::vector<MountedSensor> sensors, Trajectory drive,
                 const Executor& executor)
    : scene_(scene), executor_(executor), sensors_(std::move(sensors)), drive_(std::move(drive)) {
  for (const MountedSensor& sensor : sensors_) step_s_ = std::max(step_s_, turn_of(sensor));
  for (const MountedSensor& sensor : sensors_) scans_a_step_.push_back(scans_in(step_s_, sensor));
  begin_s_ = time_s_ = drive_.front().time_s;
  if (const World* const world = scene_.world())
    for (std::size_t i = 0; i < world->object_count(); ++i) {
      const WorldObject& object = world->object(i);
      objects_.emplace(next_id_++, Placed{i, object.name, false, std::nullopt});
      next_instance_ = std::max<std::uint16_t>(next_instance_, object.instance + 1);
    }
  make_simulators();
}

void LiveRig::make_simulators() {
  std::vector<std::unique_ptr<ScanSimulator>> made;
  for (const MountedSensor& sensor : sensors_)
    made.push_back(std::make_unique<ScanSimulator>(scene_, sensor.settings, executor_));
  simulators_ = std::move(made);
}

RigidTransform LiveRig::vehicle_at(double time_s) const {
  return vehicle_motion_ ? vehicle_motion_->at(time_s) : interpolate(drive_, time_s);
}

void LiveRig::set_vehicle(UniformMotion motion) {
  require_upright(motion, vehicle());
  motion.from.time_s = time_s_;
  vehicle_motion_ = motion;
}

ScanMotion LiveRig::motion_of(const MountedSensor& sensor, double begin_s) const {
  constexpr int kParts = 8;  // of a revolution; between them the motion is uniform
  const double turn_s = turn_of(sensor);
  const double middle_s = begin_s + 0.5 * turn_s;
  const TimedPose reference = {middle_s, vehicle_at(middle_s) * sensor.mount};
  if (fires_at_once(sensor.settings.sensor)) return still_scans({&reference, 1}).front();
  Trajectory motion;
  motion.reserve(kParts + 1);
  for (int i = 0; i <= kParts; ++i) {
    const double time_s = begin_s + turn_s * i / kParts;
    motion.push_back({time_s, vehicle_at(time_s) * sensor.mount});
  }
  return moving_scans({&reference, 1}, motion, turn_s).front();
}

/// Objects that the user moves have poses for the next step only, and a little before and after.
void LiveRig::place_objects() {
  constexpr int kParts = 6;
  for (const auto& [id, object] : objects_) {
    if (!object.motion) continue;
    const bool is_still =
        object.motion->is_at_rest() && !scene_.world()->object(object.number).only_during;
    const int parts = is_still ? 0 : kParts;
    Trajectory poses;
    poses.reserve(kParts + 1);
    for (int i = 0; i <= parts; ++i) {
      const double time_s = time_s_ + step_s_ * (i - 1) / (kParts - 2);
      poses.push_back({time_s, object.motion->at(time_s)});
    }
    scene_.move_object(object.number, std::move(poses));
  }
}

LiveStep LiveRig::step() {
  place_objects();
  LiveStep step;
  step.number = steps_;
  step.begin_s = time_s_;
  step.duration_s = step_s_;
  for (std::size_t k = 0; k < sensors_.size(); ++k)
    for (std::size_t i = 0; i < scans_a_step_[k]; ++i) {
      const std::uint64_t number = steps_ * scans_a_step_[k] + i;
      const double begin_s = time_s_ + static_cast<double>(i) * turn_of(sensors_[k]);
      step.scans.push_back({k, std::make_shared<const Scan>(
                                   simulators_[k]->scan(motion_of(sensors_[k], begin_s), number))});
    }
  std::ranges::stable_sort(step.scans, {},
                           [](const LiveScan& live) { return ScanView(*live.scan).begin_s(); });
  constexpr int kPoses = 4;
  for (int i = 0; i <= kPoses; ++i) {
    const double time_s = time_s_ + step_s_ * i / kPoses;
    step.vehicle.push_back({time_s, vehicle_at(time_s)});
  }
  ++steps_;
  // Not a sum of steps, so that times do not drift.
  time_s_ = begin_s_ + static_cast<double>(steps_) * step_s_;
  return step;
}

Image LiveRig::picture(const MountedCamera& camera, Session& session) {
  place_objects();
  if (scene_.world() != nullptr) scene_.show_at(time_s_, session);
  ImageOptions options;
  options.color = scene_.default_color();
  return scene_.render(camera.at(vehicle()), options);
}

RigidTransform LiveRig::pose_of(const Placed& object) const {
  return object.motion ? object.motion->at(time_s_)
                       : interpolate(scene_.world()->object(object.number).trajectory, time_s_);
}

std::vector<LiveObject> LiveRig::objects() const {
  std::vector<LiveObject> objects;
  objects.reserve(objects_.size());
  for (const auto& [id, object] : objects_) {
    const WorldObject& own = scene_.world()->object(object.number);
    objects.push_back({id, own.name, object.like, pose_of(object), own.instance});
  }
  return objects;
}

LiveRig::Placed& LiveRig::placed(std::uint64_t id) {
  const auto found = objects_.find(id);
  if (found == objects_.end()) throw Error(ErrorKind::no_input, "no object " + std::to_string(id));
  return found->second;
}

std::uint64_t LiveRig::spawn(const std::string& like, UniformMotion motion) {
  motion.from.time_s = time_s_;
  const World* const world = scene_.world();
  if (objects_.size() >= kMaxObjects)
    throw Error(ErrorKind::usage, "the world has too many objects; remove some");
  const std::size_t count = world == nullptr ? 0 : world->object_count();
  std::size_t model = 0;
  while (model < count && world->object(model).name != like) ++model;
  if (model == count) throw Error(ErrorKind::usage, "like: the world has no object '" + like + "'");
  require_upright(motion, interpolate(world->object(model).trajectory, time_s_));
  const auto is_like = [&](const Placed& one) { return one.like == like; };
  if (const auto found = std::ranges::find_if(free_, is_like); found != free_.end()) {
    Placed again = *found;
    free_.erase(found);
    again.motion = motion;
    scene_.set_object_present(again.number, true);
    objects_.emplace(next_id_, std::move(again));
    return next_id_++;
  }
  if (next_instance_ == 0)
    throw Error(ErrorKind::usage,
                "all instance numbers are used; only objects whose copies were removed can be "
                "spawned");
  WorldObject copy = world->object(model);
  copy.name = like + " " + std::to_string(next_id_);
  copy.instance = next_instance_++;
  copy.trajectory = {{time_s_, motion.at(time_s_)}};
  copy.only_during = false;
  copy.only_scan.reset();
  copy.present = true;
  const std::size_t number = scene_.add_object(std::move(copy));
  try {
    make_simulators();  // the tables of attributes are longer
  } catch (...) {
    scene_.set_object_present(number, false);
    throw;
  }
  objects_.emplace(next_id_, Placed{number, like, true, motion});
  return next_id_++;
}

void LiveRig::move(std::uint64_t id, UniformMotion motion) {
  Placed& object = placed(id);
  require_upright(motion, pose_of(object));
  motion.from.time_s = time_s_;
  object.motion = motion;
}

void LiveRig::remove(std::uint64_t id) {
  Placed& object = placed(id);
  scene_.set_object_present(object.number, false);
  // An object of the world file may be absent at times, so it is not used again.
  if (object.is_copy) free_.push_back(object);
  objects_.erase(id);
}

}  // namespace adasplats
