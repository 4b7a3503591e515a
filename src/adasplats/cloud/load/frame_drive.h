// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// A drive whose scans are files of points in world coordinates, each with its time, and the
/// trajectory of the vehicle (or sensor) in the same clock, as PandaSet and many mapping systems
/// have them.
struct FrameDrive {
  std::filesystem::path folder;      ///< of the files, one a scan by name
  std::filesystem::path trajectory;  ///< as read_trajectory takes it
  std::filesystem::path boxes;       ///< of moving objects (MovingBoxes); empty: none
  bool with_classes = true;          ///< as the files have them
  double time_offset_s = 0;          ///< what the points' times lack to those of the trajectory
};

/// Whether a folder holds files of points of one extension, the first of which has times of at most
/// a second: scans, not tiles of a recording.
bool has_timed_frames(const std::filesystem::path& folder);

/// Finds which sensor of the library measured the points and how it is mounted (recognize_sensor);
/// every beam then begins where the sensor was at the point's own time. A scan's pose is that of
/// the middle of its times. Nothing, with a warning, where no sensor is recognised. Errors: data
/// where the trajectory does not cover the times by more than the distance of its poses: nothing is
/// extrapolated.
std::optional<KittiSequence> open_frame_drive(const FrameDrive& drive, const Executor& executor,
                                              ProgressSink& progress);

}  // namespace adasplats
