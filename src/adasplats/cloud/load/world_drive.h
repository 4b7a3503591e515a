// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Scans in world coordinates with point times, and the trajectory of their vehicle.
struct WorldFrames {
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const ScanSource> source = scans_in_files();  ///< reads them
  Trajectory vehicle;                ///< in the clock of the points; not empty
  std::filesystem::path poses_file;  ///< for messages
  /// Of the files, in the clock of annotated boxes (BoxContent::are_of_scans); empty: none.
  std::vector<double> stamps_s;
  /// Mount of the sensor on the vehicle if it is not recognised; none: then it is unknown.
  std::optional<RigidTransform> own_mount;
  std::string others;      ///< name of the points that FileScan::left_out counts
  bool is_stated = false;  ///< the user gives own_mount, so the sensor is not recognised
};

/// Opens scans in world coordinates as a drive (open_drive()); nothing, with a warning, if
/// the mount of the sensor is unknown. A single scan with a single pose within a second of it keeps
/// that pose all the time.
std::optional<KittiSequence> open_world_frames(const DriveInput& drive, const WorldFrames& frames,
                                               const Executor& executor, ProgressSink& progress);

/// The sensor of the scans and its mount on the vehicle, as open_world_frames() recognises it from
/// a few of them; nothing if it is not recognised.
std::optional<Recognition> recognize_in_world(const WorldFrames& frames, const Executor& executor,
                                              ProgressSink& progress);

}  // namespace adasplats
