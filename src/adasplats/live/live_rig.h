// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/rig_sensors.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/live/uniform_motion.h"
#include "adasplats/sensors/camera_file.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// A scan of one sensor of a rig.
struct LiveScan {
  std::size_t sensor = 0;
  std::shared_ptr<const Scan> scan;  ///< with all attributes
};

/// What a rig measured during one step.
struct LiveStep {
  std::uint64_t number = 0;  ///< 0: the first
  double begin_s = 0, duration_s = 0;
  Trajectory vehicle;           ///< from the begin to the end
  std::vector<LiveScan> scans;  ///< by their begin
};

/// An object of the world, as its user sees it.
struct LiveObject {
  std::uint64_t id = 0;
  std::string name, like;  ///< `like`: the object of the world file that it is a copy of
  RigidTransform world_from_object;
  std::uint16_t instance = 0;  ///< of its points
};

/// The sensors of a vehicle in a world, step by step. A step lasts a revolution of the slowest
/// sensor; faster ones make several scans. The same calls give the same scans.
class LiveRig {
 public:
  /// `drive`: poses of the vehicle; the first is the begin, and after the last one the vehicle is
  /// at rest. Scene and executor must outlive it. Errors: usage (no whole number of scans of a
  /// sensor in a step), those of ScanSimulator.
  LiveRig(ModelScene& scene, std::vector<MountedSensor> sensors, Trajectory drive,
          const Executor& executor);

  const std::vector<MountedSensor>& sensors() const { return sensors_; }
  const ModelScene& scene() const { return scene_; }
  double step_s() const { return step_s_; }
  double time_s() const { return time_s_; }  ///< begin of the next step
  std::uint64_t steps() const { return steps_; }

  /// Simulates the next step.
  LiveStep step();

  /// What a camera on the vehicle sees now.
  Image picture(const MountedCamera& camera, Session& session);

  RigidTransform vehicle() const { return vehicle_at(time_s_); }
  /// From now on; `from.time_s` is not used. Errors: usage (it would fall on its side at once).
  void set_vehicle(UniformMotion motion);
  /// Back to the poses of the drive at this time.
  void follow_drive() { vehicle_motion_.reset(); }

  std::vector<LiveObject> objects() const;
  /// Adds a copy of an object of the world file. `from.time_s` is not used. Errors: usage (no such
  /// object, too many objects, one on its side).
  std::uint64_t spawn(const std::string& like, UniformMotion motion);
  /// Errors: no_input (no such object), usage (it would fall on its side at once).
  void move(std::uint64_t id, UniformMotion motion);
  void remove(std::uint64_t id);

 private:
  struct Placed {
    std::size_t number;  ///< in the world
    std::string like;
    bool is_copy = false;                 ///< that spawn() made
    std::optional<UniformMotion> motion;  ///< none: that of the world file
  };

  RigidTransform vehicle_at(double time_s) const;
  ScanMotion motion_of(const MountedSensor& sensor, double begin_s) const;
  void make_simulators();
  Placed& placed(std::uint64_t id);
  RigidTransform pose_of(const Placed& object) const;
  void place_objects();

  ModelScene& scene_;
  const Executor& executor_;
  std::vector<MountedSensor> sensors_;
  std::vector<std::unique_ptr<ScanSimulator>> simulators_;
  std::vector<std::size_t> scans_a_step_;
  Trajectory drive_;
  double step_s_ = 0, begin_s_ = 0, time_s_ = 0;
  std::uint64_t steps_ = 0;
  std::optional<UniformMotion> vehicle_motion_;
  std::map<std::uint64_t, Placed> objects_;
  std::vector<Placed> free_;  ///< removed copies, which spawn() uses again
  std::uint64_t next_id_ = 1;
  std::uint16_t next_instance_ = 1;
};

}  // namespace adasplats
