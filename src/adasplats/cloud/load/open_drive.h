// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/poses/mount.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// A drive to open: where its scans are, and how to read them.
struct DriveInput : DriveSettings {
  /// A folder of files, one per scan (scan_files()), a recording (is_recording()), a capture
  /// (is_capture()), or the root of a data set (data_tree_of()).
  std::filesystem::path folder;
  bool with_classes = true;  ///< read the classes that the files have
  /// A sensor of a rig: points in world coordinates with a stated mount are a drive, too, and
  /// `packet_sensor` may name the sensor of points instead of packets.
  bool is_rig_sensor = false;
};

inline DriveInput drive_of(const std::filesystem::path& folder, const DriveSettings& settings) {
  return {settings, folder};
}

/// Whether a path is a drive without a trajectory file or a folder of scan files: a recording, a
/// packet capture, or the root of a data set. Recordings and data sets contain the poses of their
/// scans.
bool is_self_contained_drive(const std::filesystem::path& path);

/// Whether a folder contains point files of one extension, and the times of the first span at most
/// a second: scans, not tiles of a recording.
bool has_timed_frames(const std::filesystem::path& folder);

/// Opens a drive with points in the sensor frame, or in world coordinates with times. Unless
/// points_in states the frame, find_frame() infers it.
/// - Sensor frame: each file has a pose (poses_of_files()). Points with times (of a clock, or
///   offsets from the scan's time, in s, ms, us or ns) are brought to the time of the scan if they
///   are as measured (analyze_sweeps()). The poses must fit the scans (verify_poses()).
/// - World coordinates: recognize_sensor() finds the sensor in the library and its mount. Every
///   beam starts where the sensor was at the time of the point. The pose of a scan is that of the
///   middle of its times. The result is described in KittiSequence::facts and in a warning. Nothing
///   if the folder has no scans with poses, or if its points are in world coordinates and have no
///   times, a stated mount, or (with a warning) a sensor that is not recognised. Errors: data if
///   the trajectory does not cover the times (up to one step of its poses), if the poses contradict
///   the points, and if the frame is undetermined.
std::optional<KittiSequence> open_drive(const DriveInput& drive, const Executor& executor,
                                        ProgressSink& progress);

}  // namespace adasplats
