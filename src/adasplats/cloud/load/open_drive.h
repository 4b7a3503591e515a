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

/// A drive whose scans are files of points, and the trajectory of the vehicle or of the sensor.
struct FrameDrive : DriveSettings {
  /// A folder of files, one per scan (scan_files()), a recording (is_recording()), a capture
  /// (is_capture()), or the root of a data set (data_tree_of()).
  std::filesystem::path folder;
  bool with_classes = true;  ///< read the classes that the files have
};

inline FrameDrive drive_of(const std::filesystem::path& folder, const DriveSettings& settings) {
  return {settings, folder};
}

/// Whether a path is a drive and no folder of files: a recording, a capture of packets, or a tree
/// of a data set. Recordings and trees have the poses of their scans in them.
bool is_drive_by_itself(const std::filesystem::path& path);

/// Whether a folder holds files of points of one extension, the first of which has times of at most
/// a second: scans, not tiles of a recording.
bool has_timed_frames(const std::filesystem::path& folder);

/// Opens a drive whose points are in the frame of the sensor, or in the world with times; which of
/// both is found (find_frame()) where it is not stated.
/// - In the sensor's frame, each file has a pose (poses_of_files()); points with times of their own
///   (a clock's, or offsets from the scan's, in s, ms, us or ns) are brought to its time where they
///   are as measured (look_at_sweeps()). The poses must fit the scans (require_poses_that_fit()).
/// - In the world, it is found which sensor of the library measured the points and how it is
///   mounted (recognize_sensor); every beam then begins where the sensor was at the point's own
///   time. A scan's pose is that of the middle of its times.
/// What was understood is KittiSequence::facts, and a warning. Nothing where the folder is none of
/// scans with poses, and for points in world coordinates without times, with a stated mount or,
/// with a warning, of a sensor that is not recognised. Errors: data where the trajectory does not
/// cover the times by more than the distance of its poses (nothing is extrapolated), where the
/// poses contradict the points, and where nothing tells the frame.
std::optional<KittiSequence> open_frame_drive(const FrameDrive& drive, const Executor& executor,
                                              ProgressSink& progress);

}  // namespace adasplats
