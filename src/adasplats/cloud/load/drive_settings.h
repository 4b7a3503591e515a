// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/poses/mount.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/core/words.h"

namespace adasplats {

class MovingBoxes;

/// The frame of the points in a drive's files.
enum class PointsIn : std::uint8_t {
  found,   ///< inferred from the points and the poses
  sensor,  ///< each file in the frame of the sensor (or vehicle) at its scan
  world    ///< all files in one frame
};
inline constexpr std::pair<std::string_view, PointsIn> kPointsIn[] = {
    {"auto", PointsIn::found}, {"sensor", PointsIn::sensor}, {"world", PointsIn::world}};
inline Words<PointsIn> words_of(PointsIn) { return kPointsIn; }

/// Whether points in the sensor frame still contain the motion of the sensor within a sweep.
enum class SweepPoints : std::uint8_t {
  found,       ///< inferred from the cones of the sensor's beams
  measured,    ///< each point in the frame of the sensor at its own time
  compensated  ///< all points of a scan in the frame of the sensor at one time
};
inline constexpr std::pair<std::string_view, SweepPoints> kSweepPoints[] = {
    {"auto", SweepPoints::found},
    {"measured", SweepPoints::measured},
    {"compensated", SweepPoints::compensated}};
inline Words<SweepPoints> words_of(SweepPoints) { return kSweepPoints; }

/// How to read a drive. Used to load its points and to cast its beams again.
struct DriveSettings {
  /// Of the vehicle or of the sensor, as read by read_trajectory.
  std::filesystem::path trajectory;
  /// Boxes of moving objects (read_box_file()); points in them are removed from scans.
  std::filesystem::path boxes;
  /// The same in memory, instead: those of find_moving().
  std::shared_ptr<const MovingBoxes> found_boxes;
  /// Lever arm: position of the sensor in the frame of the trajectory's poses, m. Not set: the
  /// poses are the sensor's own, or the mount is recognised.
  std::optional<Vec3d> mount;
  /// Boresight: yaw, pitch and roll of the sensor in that frame, degrees. For points in world
  /// coordinates it only turns the poses of scans; origins do not change.
  Vec3d mount_rotation_deg;
  /// Added to the points' times to get those of the trajectory, s. Not set: inferred
  /// (possible_clocks).
  std::optional<double> time_offset_s;
  PointsIn points_in = PointsIn::found;
  SweepPoints sweep_points = SweepPoints::found;
  std::filesystem::path scan_times;  ///< read_scan_times(); empty: none
  /// Topics of a recording with the scans and with the poses; empty: chosen automatically. For a
  /// capture `topic` is the sensor, "192.168.1.201:2368"; for a data set DataTree::sensors.
  std::string topic, poses_topic;
  std::string scene;  ///< of a nuScenes data root; empty: its only scene
  /// The sensor that sent the packets of a capture or recording (load_lidar_model()).
  std::string packet_sensor;
  /// Start beams at the poses even if the sensor is recognised (ScanBeams).
  bool beams_from_poses = false;

  bool operator==(const DriveSettings&) const = default;

  /// The mount, if a position or a rotation is set.
  std::optional<MountSettings> given_mount() const {
    if (!mount && mount_rotation_deg == Vec3d{}) return std::nullopt;
    return MountSettings{mount.value_or(Vec3d{}), mount_rotation_deg};
  }
};

/// The mount of the sensor and the offset of its clock.
template <class Visit>
void visit_mount_settings(DriveSettings& drive, const char* group, Visit&& visit) {
  visit(Setting{.name = "mount",
                .help = "Lever arm: sensor position in the frame of the trajectory's poses, m "
                        "(default: the poses are the sensor's)",
                .group = group},
        drive.mount);
  visit(Setting{.name = "mount_rotation",
                .help = "Boresight: yaw, pitch and roll of the sensor in the frame of the "
                        "trajectory's poses, degrees. It rotates the poses of scans only, so "
                        "points in world coordinates need none",
                .key = "mount_rotation_deg",
                .group = group},
        drive.mount_rotation_deg);
  visit(Setting{.name = "time_offset",
                .help = "Seconds to add to the times of points to get times of the trajectory "
                        "(default: inferred from GPS, UTC and PTP clocks)",
                .value = "S",
                .key = "time_offset_s",
                .group = group},
        drive.time_offset_s);
}

/// How to read the scans.
template <class Visit>
void visit_scan_settings(DriveSettings& drive, const char* group, Visit&& visit) {
  visit(
      Setting{.name = "points_in",
              .help = "Frame of the points in a folder of scans with a trajectory (auto: inferred)",
              .group = group},
      drive.points_in);
  visit(
      Setting{
          .name = "sweep_points",
          .help = "Whether scans with times are as measured or motion-compensated (auto: inferred)",
          .group = group},
      drive.sweep_points);
  visit(Setting{.name = "scan_times",
                .help = "Times of the scans of a folder, s, one per line in the order of the file "
                        "names, in the clock of the trajectory",
                .value = "FILE",
                .group = group},
        drive.scan_times);
  visit(Setting{.name = "topic",
                .help = "MCAP, ROS bag: topic of the points or packets; PCAP: sensor by "
                        "ADDRESS:PORT; PandaSet, Argoverse 2: LiDAR (default: the only one, or "
                        "all)",
                .value = "NAME",
                .group = group},
        drive.topic);
  visit(Setting{.name = "poses_topic",
                .help = "MCAP, ROS bag: topic of the poses, of type tf, odometry or poses "
                        "(default: tf, else the only one)",
                .value = "NAME",
                .group = group},
        drive.poses_topic);
  visit(Setting{.name = "scene",
                .help = "nuScenes: name of the scene (default: the only one)",
                .value = "NAME",
                .group = group},
        drive.scene);
  visit(Setting{.name = "packet_sensor",
                .help = "PCAP, packets in bags: sensor that sent them, by name or "
                        "manufacturer's file (default: Ouster metadata in the bag, metadata.json "
                        "or calibration*.yaml next to the file)",
                .value = "SENSOR",
                .group = group},
        drive.packet_sensor);
}

}  // namespace adasplats
