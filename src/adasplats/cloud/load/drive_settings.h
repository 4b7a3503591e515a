// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/poses/mount.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/core/words.h"

namespace adasplats {

/// Which frame the points of a drive's files are in.
enum class PointsIn : std::uint8_t {
  found,   ///< what the points and the poses say
  sensor,  ///< each file in the frame of the sensor (or of the vehicle) at its scan
  world    ///< all files in one
};
inline constexpr std::pair<std::string_view, PointsIn> kPointsIn[] = {
    {"auto", PointsIn::found}, {"sensor", PointsIn::sensor}, {"world", PointsIn::world}};
inline Words<PointsIn> words_of(PointsIn) { return kPointsIn; }

/// Whether the motion of the sensor within a sweep is still in points of the sensor's frame.
enum class SweepPoints : std::uint8_t {
  found,       ///< what the cones of the sensor's beams say
  measured,    ///< each point in the frame of the sensor at its own time
  compensated  ///< all points of a scan in the frame of the sensor at one time
};
inline constexpr std::pair<std::string_view, SweepPoints> kSweepPoints[] = {
    {"auto", SweepPoints::found},
    {"measured", SweepPoints::measured},
    {"compensated", SweepPoints::compensated}};
inline Words<SweepPoints> words_of(SweepPoints) { return kSweepPoints; }

/// How a drive whose scans are files, given with a trajectory, is meant; for what loads points and
/// for what casts their beams again.
struct DriveSettings {
  /// Of the vehicle or of the sensor, as read_trajectory takes it.
  std::filesystem::path trajectory;
  /// Boxes of moving objects (MovingBoxes), whose points are left out of scans with times.
  std::filesystem::path boxes;
  /// The lever arm: where the sensor sits in the frame of the trajectory's poses, m. Not given: the
  /// poses are the sensor's own, or it is found.
  std::optional<Vec3d> mount;
  /// The boresight: yaw, pitch and roll of the sensor there, degrees. Of points in world
  /// coordinates it turns the poses of scans and moves no origin.
  Vec3d mount_rotation_deg;
  /// What points' times lack to those of the trajectory, s. Not given: found (possible_clocks).
  std::optional<double> time_offset_s;
  PointsIn points_in = PointsIn::found;
  SweepPoints sweep_points = SweepPoints::found;
  std::filesystem::path scan_times;  ///< read_scan_times(); empty: none
  /// Of a recording: whose clouds are the scans, and what topic says the poses; empty: found.
  std::string topic, poses_topic;
  std::string scene;  ///< of a data root of nuScenes; empty: the only one
  /// Of a capture of packets: the sensor that sent them (load_lidar_model()).
  std::string packets_of;
  /// Beams start at their poses even where they are seen to start beside them (ScanBeams).
  bool beams_from_poses = false;

  /// As far as one is given; a rotation alone is one.
  std::optional<MountSettings> given_mount() const {
    if (!mount && mount_rotation_deg == Vec3d{}) return std::nullopt;
    return MountSettings{mount.value_or(Vec3d{}), mount_rotation_deg};
  }
};

/// Where the sensor sits and what its clock lacks.
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

/// How the scans are meant.
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
                .help = "MCAP, ROS bag: topic of the points (default: the only one)",
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
                .help = "PCAP: sensor that sent the packets, by name or manufacturer's file "
                        "(default: metadata.json or calibration*.yaml next to the capture)",
                .value = "SENSOR",
                .group = group,
                .old_name = "packets_of"},
        drive.packets_of);
}

}  // namespace adasplats
