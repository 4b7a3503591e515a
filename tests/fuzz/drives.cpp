// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/av2_drive.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/pandaset_drive.h"
#include "adasplats/cloud/load/rig.h"
#include "adasplats/cloud/load/scan_stamps.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/io/base/atomic_file.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {
namespace {

void require_sound(const Trajectory& trajectory) {
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const TimedPose& pose = trajectory[k];
    require(std::isfinite(pose.time_s) && is_finite(pose.world_from_sensor.translation),
            "poses that are finite");
    require(orthonormality_error(pose.world_from_sensor.rotation) < 1e-2, "rotations");
    require(k == 0 || pose.time_s > trajectory[k - 1].time_s, "times that ascend");
  }
}

void require_sound(const KittiSequence& sequence) {
  require(sequence.trajectory.size() == sequence.scans.size(), "a pose a scan");
  require_sound(sequence.trajectory);
  for (std::size_t k = 0; k < sequence.scans.size(); ++k) {
    const KittiScan scan = read_kitti_scan(sequence, k);
    require(scan.intensities.empty() || scan.intensities.size() == scan.positions.size(),
            "an intensity a point");
    require(scan.classes.empty() || scan.classes.size() == scan.positions.size(),
            "a class a point");
  }
}

void require_sound(const MovingBoxes& boxes) {
  for (const BoxTrack& track : boxes.tracks()) {
    require(!track.boxes.empty(), "a box a track");
    for (std::size_t k = 0; k < track.boxes.size(); ++k) {
      const TimedBox& box = track.boxes[k];
      require(is_finite(box.middle) && std::isfinite(box.yaw_rad), "boxes that are finite");
      require(std::min({box.half_size.x, box.half_size.y, box.half_size.z}) > 0,
              "sizes that are positive");
      require(k == 0 || box.time_s > track.boxes[k - 1].time_s, "times that ascend");
    }
    boxes.object_at(track.boxes.front().time_s, track.boxes.front().middle);
  }
  boxes.object_at(0.5, {1, 2, 3});
}

}  // namespace

void read_pose_file(const Input& input) {
  kind_of_file(input.file);
  has_times(input.file);
  trajectory_files(input.file);
  require_sound(read_trajectory(input.file));
}

void read_times(const Input& input) {
  constexpr std::size_t kCount = 3;
  require(read_scan_times(input.file, kCount).size() == kCount, "as many as were asked for");
}

void read_boxes(const Input& input) {
  BoxDrive drive;
  for (int k = 0; k < 4; ++k) {
    drive.scans.push_back("000000000" + std::to_string(k) + ".bin");
    drive.poses.push_back({0.1 * k, {{}, {1.0 * k, 0, 0}}});
  }
  require_sound(MovingBoxes(read_box_file(input.file, drive)));
}

void read_box_folder(const Input& input) {
  for (const std::string_view lidar : kPandaSetSensors)
    require_sound(MovingBoxes(read_box_file(input.folder, {{}, {}, std::string(lidar), ""})));
}

void open_kitti(const Input& input) { require_sound(open_kitti_sequence(input.folder)); }

void open_kitti_raw(const Input& input) { require_sound(open_kitti_raw_drive(input.folder)); }

void open_pandaset(const Input& input) {
  pandaset_class_names(input.folder);
  DriveInput drive;
  drive.folder = input.folder;
  ProgressSink quiet;
  is_pandaset_rig(input.folder);
  for (const std::string_view sensor : kPandaSetSensors) {
    drive.topic = sensor;
    require_sound(open_pandaset_drive(drive, Executor(1), quiet));
  }
}

void open_av2(const Input& input) {
  DriveInput drive;
  drive.folder = input.folder;
  ProgressSink quiet;
  require_sound(open_av2_drive(drive, Executor(1), quiet));
  for (const std::string_view sensor : kAv2Sensors) {
    drive.topic = sensor;
    require_sound(open_av2_drive(drive, Executor(1), quiet));
  }
}

void open_nuscenes(const Input& input) {
  nuscenes_class_names(input.folder);
  const NuscenesScene scene = read_nuscenes_scene(input.folder, "");
  for (std::size_t k = 0; k < scene.scans.size(); ++k) {
    const TimedPose& pose = scene.scans[k].pose;
    require(is_finite(pose.world_from_sensor.translation), "poses that are finite");
    require(k == 0 || pose.time_s > scene.scans[k - 1].pose.time_s, "times that ascend");
  }
}

void read_rig_text(const Input& input) {
  const Rig rig = parse_rig(read_file(input.file), input.file);
  const Rig back = parse_rig(rig_toml(rig), input.file);
  require(!rig.sensors.empty() && back.sensors.size() == rig.sensors.size(), "sensors");
  require(back.body.size() == rig.body.size(), "the same body in the text of the rig");
  require(back.cameras.size() == rig.cameras.size(), "the same cameras in the text of the rig");
  for (std::size_t k = 0; k < rig.sensors.size(); ++k) {
    const RigSensor &one = rig.sensors[k], &other = back.sensors[k];
    require(is_finite(one.mount.value_or(Vec3d{})), "mounts that are finite");
    require(one.name == other.name && one.mount == other.mount &&
                one.mount_rotation_deg == other.mount_rotation_deg &&
                one.time_offset_s == other.time_offset_s && one.topic == other.topic &&
                one.body.size() == other.body.size() && one.is_in_model == other.is_in_model,
            "the same sensor in the text of the rig");
  }
}

}  // namespace adasplats::fuzz
