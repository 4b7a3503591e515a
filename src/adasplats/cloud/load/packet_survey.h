// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/load/packet_file.h"
#include "adasplats/cloud/load/packet_revolutions.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/core/progress.h"
#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {

/// The index of a capture, or of the packets of a recording.
struct PacketSurvey {
  std::filesystem::path path;
  std::shared_ptr<const PacketFile> file;
  std::shared_ptr<const RecordingSurvey> recording;  ///< null: a capture
  std::shared_ptr<const PacketDecoder> decoder;      ///< null: unknown sensor
  std::map<std::string, PacketSource> sources;       ///< by "192.168.1.201:2368" or topic
  DatagramCounts counts;
};

/// Reads a capture from front to back and finds the revolutions of a sensor: Ouster's by their
/// numbers, those of an AT128 by its mirror. Velodyne's and Hesai's end at the first azimuth of the
/// sensor file; if that is 0 (unset), at the azimuth at which the capture starts, so all but the
/// last are complete. After a gap of at least half a turn, the next azimuth replaces it. Without
/// `decoder` it only counts datagrams. Memory: 90 bytes per revolution. Errors: those of
/// DatagramReader; data (more than 256 sources; a jump of the sensor's clock).
PacketSurvey survey_packets(const std::filesystem::path& path,
                            std::shared_ptr<const PacketDecoder> decoder, ProgressSink& progress);

/// Whether a recording is read by the packets in it: of the chosen topic, or if it has no clouds.
/// Errors: usage (a packet sensor for a recording without packets).
bool is_read_by_packets(const RecordingSurvey& survey, const DriveSettings& settings,
                        bool may_lack_packets = false);

/// The same for the packets of a recording. Their sensor is the stated one, else that of Ouster
/// metadata in a topic next to that of the packets, else sensor_of_capture().
PacketSurvey survey_packets(const RecordingSurvey& recording, const DriveSettings& settings,
                            ProgressSink& progress);

/// The sensor of a capture: `stated`, else the only maker's file in its folder: STEM.json,
/// metadata.json, calibration*.yaml, angle*.csv, correction*.csv or *.dat. Empty: none. Errors:
/// usage (several).
std::string sensor_of_capture(const std::filesystem::path& capture, const std::string& stated);

/// The decoder for the sensor of a capture (sensor_of_capture()); null if it is unknown. Errors:
/// those of load_lidar_model() and packet_sensor().
std::shared_ptr<const PacketDecoder> decoder_of_capture(const std::filesystem::path& capture,
                                                        const std::string& stated);

}  // namespace adasplats
