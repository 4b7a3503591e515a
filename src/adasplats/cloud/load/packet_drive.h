// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/load/frame_drive.h"
#include "adasplats/cloud/load/packet_survey.h"

namespace adasplats {

/// The sensor that sent the packets of a capture: as `stated` or found (sensor_of_capture()); null
/// where nothing tells. Errors: those of load_lidar_model() and packet_sensor().
std::shared_ptr<const PacketDecoder> decoder_of_capture(const std::filesystem::path& capture,
                                                        const std::string& stated);

/// Opens the revolutions that a sensor sent as the scans of a drive, in the frame of the sensor, as
/// measured. Poses are those of the stated trajectory in the middles of the revolutions (or one a
/// revolution, where it has no times); what they do not cover is left out as of recordings.
/// Revolutions without points are left out, too. Errors: usage (no trajectory, an unknown sensor,
/// several sources that `topic` does not choose of), data (no packets of the sensor), those of
/// survey_packets() and open_sensor_frames().
KittiSequence open_packet_drive(const FrameDrive& drive, const PacketSurvey& survey,
                                const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
