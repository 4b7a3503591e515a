// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/cloud/load/frame_drive.h"
#include "adasplats/cloud/load/sensor_frames.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

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

}  // namespace adasplats
