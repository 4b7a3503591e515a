// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/load/frame_drive.h"
#include "adasplats/cloud/load/recording_survey.h"

namespace adasplats {

/// Opens the clouds of one topic of a recording as the scans of a drive, each in the frame of its
/// sensor. Poses at the times of their headers are, in this order: those of the stated trajectory;
/// of the stated topic of poses; of the transforms (tf) between the clouds' frame and the one that
/// has no parent; of the one topic of odometry or poses that there is, with fixed transforms from
/// its child frame to the clouds' (or the stated mount). Scans that poses do not cover are left out
/// and counted, more than half of them are an error; so are clouds without points. Times of points
/// are offsets from the header's time, or of its clock, in s, ms, us or ns: where neither, an
/// error. Errors: usage (topics that are not clear, options of folders), data (frames that nothing
/// joins, clocks that differ), those of survey_recording() and open_sensor_frames().
KittiSequence open_recording_drive(const FrameDrive& drive, const RecordingSurvey& survey,
                                   const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
