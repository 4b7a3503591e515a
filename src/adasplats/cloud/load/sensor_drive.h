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
#include "adasplats/cloud/load/moving_boxes.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/scan_stamps.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/recognize_sensor.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Files of points that are scans in the frame of their sensor (or of what carries it), with their
/// poses.
struct SensorFrames {
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const ScanSource> source = scans_in_files();  ///< which reads them
  PosesOfFiles poses;                                           ///< of the frame of the points
  PointTimes times;
  /// Of absolute times, first and last of each file, s in the clock of the poses.
  std::vector<TimeSpan> spans_s;
  bool poses_are_matched = true;    ///< else those of the middles of the files' times
  std::string intensities, labels;  ///< DriveFacts'
};

/// Which sensor measured the scans, and what is known of its motion within a sweep.
struct SweepFinding {
  std::optional<Recognition> sensor;     ///< its mount is that in the frame of the points
  SweepPoints way = SweepPoints::found;  ///< found: not known
  Trajectory scan_poses;                 ///< those that the frames of the scans are of
  double moved_m = 0;  ///< most that the sensor moves within a sweep, seen at 10 m
  std::string motion;  ///< one line for users
};

/// Recognises the sensor by the cones of its beams, and tells by them whether points are as
/// measured: as they stand, or after the motion since the time of the scan is taken out of them,
/// they lie on the cones. `stated` stands for what would be found.
SweepFinding look_at_sweeps(const SensorFrames& frames, SweepPoints stated,
                            const Executor& executor);

/// Reads the scans as they stand.
std::shared_ptr<const ScanReader> raw_reader(std::shared_ptr<const ScanSource> source);
/// Reads them brought to the frames of their poses, each beam from where the sensor was.
/// Points in `boxes` at their own times (or that of their scan) are marked.
std::shared_ptr<const ScanReader> sweep_reader(const SensorFrames& frames, SweepFinding finding,
                                               MovingBoxes boxes, bool with_classes);

/// The first and last times of the points of all scans, s in the clock of the poses.
std::vector<TimeSpan> spans_of_scans(const SensorFrames& frames, const Executor& executor,
                                     ProgressSink& progress);

/// A drive of scans in the sensor's frame, whose poses are known (open_frame_drive()). `because` is
/// what says that they are in that frame. Errors: data (poses that do not fit the scans, times of
/// points that fit nothing).
KittiSequence open_sensor_frames(const FrameDrive& drive, const SensorFrames& frames,
                                 const std::string& because, const Executor& executor,
                                 ProgressSink& progress);

/// Says what was understood of a drive.
void tell_of_drive(const KittiSequence& sequence, ProgressSink& progress);

/// Of scans that were measured within `spans_s`, in the clock of the poses, those that poses cover,
/// by their numbers. Others are told of; `scans` is what they are called. Errors: data where more
/// than half of them are not covered.
std::vector<std::size_t> covered_scans(std::span<const TimeSpan> spans_s, const Track& track,
                                       const std::filesystem::path& path, const char* scans,
                                       ProgressSink& progress);

}  // namespace adasplats
