// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/rig_sensors.h"

#include <algorithm>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

Error sensor_error(const Rig& rig, const RigSensor& sensor, ErrorKind kind,
                   const std::string& message) {
  return {kind, rig.file.string() + ": sensor '" + sensor.name + "': " + message};
}

RigidTransform mount_of(const RigSensor& sensor) {
  return sensor.given_mount().value_or(MountSettings{}).transform();
}

std::string numbers_text(Vec3d v) {
  return exact_text(v.x) + ", " + exact_text(v.y) + ", " + exact_text(v.z);
}

/// The boxes that hide from `rig.sensors[which]`, in its frame. Errors: usage (it is inside of
/// one).
std::vector<BodyBox> boxes_of(const Rig& rig, std::size_t which) {
  const RigSensor& sensor = rig.sensors[which];
  const RigidTransform sensor_from_vehicle = mount_of(sensor).inverse();
  std::vector<BodyBox> boxes;
  const auto add = [&](const RigBox& box, const std::string& owner) {
    const BodyBox made = {sensor_from_vehicle * RigidTransform{{}, box.center_m}, 0.5 * box.size_m};
    if (VehicleBody{{}, {made}}.range_to_boxes({}, {1, 0, 0}) == 0)
      throw sensor_error(rig, sensor, ErrorKind::usage,
                         "its mount [" + numbers_text(mount_of(sensor).translation) +
                             "] is inside of the box [" + numbers_text(box.center_m) + ", " +
                             numbers_text(box.size_m) + "] in the body of " + owner +
                             ", so it would see nothing; move the sensor or the box");
    boxes.push_back(made);
  };
  for (const RigBox& box : rig.body) add(box, "the rig");
  for (std::size_t k = 0; k < rig.sensors.size(); ++k)
    if (k != which)
      for (const RigBox& box : rig.sensors[k].body)
        add(box, "sensor '" + rig.sensors[k].name + "'");
  return boxes;
}

}  // namespace

std::vector<MountedSensor> sensors_of_rig(const Rig& rig, const ScanChoice& scan,
                                          std::uint64_t seed) {
  std::vector<MountedSensor> sensors;
  for (std::size_t k = 0; k < rig.sensors.size(); ++k) {
    const RigSensor& sensor = rig.sensors[k];
    if (sensor.packet_sensor.empty())
      throw sensor_error(rig, sensor, ErrorKind::usage,
                         "has no key sensor, which simulation needs: a name from 'adasplats "
                         "sensors', or a file");
    if (sensor.trajectory != rig.sensors.front().trajectory)
      throw sensor_error(rig, sensor, ErrorKind::usage,
                         "its trajectory is another than that of sensor '" +
                             rig.sensors.front().name +
                             "', so their mounts refer to different frames; give all mounts in the "
                             "frame of one trajectory");
    MountedSensor made{sensor.name, {}, mount_of(sensor), sensor.time_offset_s.value_or(0), {}};
    try {
      made.settings = scan.settings_of(load_lidar_model(sensor.packet_sensor),
                                       k == 0 ? seed : Random::mix(seed + k));
    } catch (const Error& error) {
      throw sensor_error(rig, sensor, error.kind(), error.what());
    }
    std::vector<BodyBox> boxes = boxes_of(rig, k);
    LidarModel& model = made.settings.sensor;
    if (!boxes.empty() && !model.body) model.body.emplace();
    if (!boxes.empty()) model.body->boxes = std::move(boxes);
    sensors.push_back(std::move(made));
  }
  return sensors;
}

Trajectory set_scans(std::vector<MountedSensor>& sensors, const DriveOptions& drive,
                     const DrivenPoses& driven, ProgressSink& progress) {
  ProgressSink silent;  // the vehicle has reported the warnings
  const auto slowest = std::ranges::min_element(sensors, {}, [](const MountedSensor& sensor) {
    const LidarModel& model = sensor.settings.sensor;
    return std::pair(fires_at_once(model), model.rotation_hz);
  });
  Trajectory vehicle;
  for (const ScanMotion& scan : scans_at(drive, slowest->settings.sensor, driven, progress)) {
    const double step_s =
        scan.duration_s / static_cast<double>(std::max<std::size_t>(2, scan.knot_count()) - 1);
    for (std::size_t k = 0; k < scan.knot_count(); ++k)
      vehicle.push_back(scan.knots.empty()
                            ? scan.reference
                            : TimedPose{scan.reference.time_s - 0.5 * scan.duration_s +
                                            static_cast<double>(k) * step_s,
                                        scan.knots[k]});
  }
  std::ranges::stable_sort(vehicle, {}, &TimedPose::time_s);
  constexpr double kSame_s = 1e-6;
  const auto is_same = [](const TimedPose& a, const TimedPose& b) {
    return b.time_s - a.time_s < kSame_s;
  };
  vehicle.erase(std::unique(vehicle.begin(), vehicle.end(), is_same), vehicle.end());
  for (MountedSensor& sensor : sensors) {
    DriveOptions mounted_drive = drive;
    mounted_drive.mount = sensor.mount;
    sensor.scans = scans_at(mounted_drive, sensor.settings.sensor, driven, silent);
  }
  return vehicle;
}

}  // namespace adasplats
