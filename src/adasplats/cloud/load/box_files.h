// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/moving_boxes.h"

namespace adasplats {

/// The drive that boxes are read for, as far as their files refer to it.
struct BoxDrive {
  std::vector<std::filesystem::path> scans;  ///< by time
  Trajectory poses;                          ///< of the scans: world_from_sensor
  std::string lidar;  ///< of kPandaSetSensors, whose cuboids are preferred; empty: pandar64
  std::string scene;  ///< of nuScenes; empty: the only one
};

/// Reads boxes; the content decides on the format.
/// - CSV: read_csv_boxes().
/// - PandaSet: a sequence or its folder annotations/cuboids: read_pandaset_boxes().
/// - Argoverse 2: annotations.feather, or the folder that contains it: read_av2_boxes().
/// - KITTI raw: tracklet_labels.xml, or the folder that contains it: read_kitti_tracklets().
/// - nuScenes: sample_annotation.json, or the root of the data set: read_nuscenes_boxes().
/// Only the yaw of a box is kept; slopes of the road do not tilt it. Errors: no_input, data with
/// the file and the line, row or object.
BoxContent read_box_file(const std::filesystem::path& path, const BoxDrive& drive);

/// Whether a box file numbers the scans of its drive (KITTI's tracklets): it is of one drive.
bool is_of_numbered_scans(const std::filesystem::path& boxes);

/// A CSV with the columns time, id, stationary (0: it moves), x, y, z (of the centre, world
/// coordinates, m), size_x, size_y, size_z (m), yaw (rad), and optionally label. Other columns are
/// skipped. An object moves if one of its boxes does.
BoxContent read_csv_boxes(const std::filesystem::path& file);

/// annotations/cuboids/NN.pkl.gz of PandaSet (docs of pandaset-devkit 59be180,
/// python/pandaset/annotations.py): one frame for each time of lidar/timestamps.json, or else of
/// meta/timestamps.json. Siblings are one object, unless one LiDAR has a cuboid of each in the same
/// frame. Of siblings in a frame the one of `lidar` counts. Column stationary decides whether an
/// object moves.
BoxContent read_pandaset_boxes(const std::filesystem::path& cuboids, const std::string& lidar);

/// annotations.feather of an Argoverse 2 log, in the frame of the vehicle at the stamp; poses are
/// those of city_SE3_egovehicle.feather next to it. moves_by_boxes() decides what moves.
BoxContent read_av2_boxes(const std::filesystem::path& file);

/// tracklet_labels.xml of KITTI's raw data (its devkit's readme and tracklets.h): the middle of the
/// lower side in the frame of the LiDAR at a scan, which is identified by the number in its file
/// name. Boxes of scans that the drive lacks between others are skipped. moves_by_boxes() decides
/// what moves. Errors: data, too, without scans in the frame of the sensor, for unsynchronised
/// scans (.txt), which have other numbers, and for scans beyond the first or last.
BoxContent read_kitti_tracklets(const std::filesystem::path& file, const BoxDrive& drive);

/// sample_annotation.json of nuScenes (docs/schema_nuscenes.md of its devkit) for one scene, at the
/// times of its samples. `tables`: the folder v1.0-*. moves_by_boxes() decides what moves. Errors:
/// usage, too, for an unknown scene.
BoxContent read_nuscenes_boxes(const std::filesystem::path& tables, const std::string& scene);

}  // namespace adasplats
