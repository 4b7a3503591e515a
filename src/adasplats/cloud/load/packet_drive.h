// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/packet_survey.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Opens the revolutions of a capture or recording as the scans of a drive, in the sensor frame, as
/// measured. Poses are those of the given trajectory at the middles of the revolutions (or one per
/// revolution, without times); in a recording also those of open_recording_drive(). Revolutions
/// without poses or points are skipped. Errors: usage (no trajectory, an unknown sensor, several
/// sources and no `topic`), data (no packets of the sensor), those of survey_packets() and
/// open_sensor_frames().
KittiSequence open_packet_drive(const DriveInput& drive, const PacketSurvey& survey,
                                const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
