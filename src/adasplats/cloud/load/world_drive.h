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
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Scans in world coordinates whose points have times, and where their vehicle was.
struct WorldFrames {
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const ScanSource> source = scans_in_files();  ///< which reads them
  Trajectory vehicle;                ///< in the clock of the points; not empty
  std::filesystem::path poses_file;  ///< for messages
  /// Where the sensor sits on the vehicle unless it is recognised; none: then it is not known.
  std::optional<RigidTransform> own_mount;
  std::string others;      ///< what FileScan::left_out counts, in words
  bool is_stated = false;  ///< own_mount is what the user says: nothing is to be recognised
};

/// Opens scans in world coordinates as a drive (open_frame_drive()); nothing, with a warning, where
/// it is not known where the sensor sits. Of a single scan with a single pose that is its pose all
/// the time, if it is not a second apart.
std::optional<KittiSequence> open_world_frames(const FrameDrive& drive, const WorldFrames& frames,
                                               const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
