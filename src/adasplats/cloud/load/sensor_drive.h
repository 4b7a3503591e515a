// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/scan_stamps.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Scans in the frame of their sensor (or vehicle), with their poses.
struct SensorFrames {
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const ScanSource> source = scans_in_files();  ///< reads them
  PosesOfFiles poses;                                           ///< of the frame of the points
  PointTimes times;
  /// First and last time of each file, if times are absolute, s in the clock of the poses.
  std::vector<TimeSpan> spans_s;
  bool poses_are_matched = true;    ///< else they are those at the middles of the files' times
  std::string intensities, labels;  ///< for DriveFacts
  /// The sensor whose packets these are: the points are in its frame, and its file defines lasers
  /// and origins. Nothing: it is to be recognised.
  std::optional<SensorCones> sensor;
};

/// The sensor of the scans, and how it moves within a sweep.
struct SweepFinding {
  std::optional<Recognition> sensor;     ///< with its mount in the frame of the points
  SweepPoints way = SweepPoints::found;  ///< found: undetermined
  Trajectory scan_poses;                 ///< of the frames of the scans
  double moved_m = 0;  ///< maximum motion of the sensor within a sweep, seen at 10 m
  std::string motion;  ///< one line for users
};

/// Recognises the sensor, unless it is known, by the cones of its beams. Points as measured are on
/// the cones as given; motion-compensated points are on them once the compensation is undone.
/// `stated` overrides what would be inferred.
SweepFinding analyze_sweeps(const SensorFrames& frames, SweepPoints stated,
                            const Executor& executor);

/// Reads the scans as given.
std::shared_ptr<const ScanReader> raw_reader(std::shared_ptr<const ScanSource> source);
/// Reads the scans in the frames of their poses; each beam starts where the sensor was.
std::shared_ptr<const ScanReader> sweep_reader(const SensorFrames& frames, SweepFinding finding,
                                               bool with_classes);

/// First and last time of the points of each scan, s in the clock of the poses.
std::vector<TimeSpan> spans_of_scans(const SensorFrames& frames, const Executor& executor,
                                     ProgressSink& progress);

/// Opens scans in the sensor frame with their poses as a drive (open_drive()). `because` is
/// the evidence for that frame. Errors: data (poses that do not fit the scans; point times without
/// a meaning).
KittiSequence open_sensor_frames(const DriveInput& drive, const SensorFrames& frames,
                                 const std::string& because, const Executor& executor,
                                 ProgressSink& progress);

/// Reports the facts of a drive as a warning.
void report_drive(const KittiSequence& sequence, ProgressSink& progress);

/// Indices of the scans that the track covers. `spans_s`: their times in the clock of the poses.
/// Warns of the others, called `scans`. Errors: data if more than half are not covered.
std::vector<std::size_t> covered_scans(std::span<const TimeSpan> spans_s, const Track& track,
                                       const std::filesystem::path& path, const char* scans,
                                       ProgressSink& progress);

}  // namespace adasplats
