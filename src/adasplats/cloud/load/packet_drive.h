// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/packet_file.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/core/progress.h"
#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {

/// One turn of a sensor's head in a capture or a recording.
struct Revolution {
  PacketPlace place;          ///< of the packet that it begins in
  std::size_t skipped = 0;    ///< columns of that packet that belong to the previous revolution
  std::size_t columns = 0;    ///< captured ones
  double share = 0;           ///< fraction of a full turn, from its first to its last column
  std::int64_t begin_ns = 0;  ///< when its first column was measured, since 1970
  std::int64_t end_ns = 0;    ///< when its last one ended
  bool has_points = false;
};

/// The datagrams from one address to one port, or of one topic.
struct PacketSource {
  std::uint64_t datagrams = 0;
  std::uint64_t packets = 0;                 ///< of the sensor
  std::uint64_t dual_packets = 0;            ///< those with two returns per firing
  std::uint64_t gaps = 0, lost_columns = 0;  ///< from missing packets
  std::string objection;  ///< why some datagrams of the right size are rejected; empty: none are
  /// How packets contradict the sensor's file (PacketDecoder::contradiction()); empty: none do.
  std::string contradiction;
  std::uint64_t contradictions = 0;  ///< packets that do
  std::uint64_t odd_turns = 0;       ///< ends of revolutions after another number of columns
  /// Sensors of the library whose packets the first ones may be ("velodyne-vlp-16"), if the sensor
  /// is unknown or another.
  std::vector<std::string> candidates;
  std::int64_t ahead_ns = 0;  ///< the clock of the capture less the sensor's, before ahead_ns
  std::vector<Revolution> revolutions;
};

/// The index of a capture, or of the packets of a recording.
struct PacketSurvey {
  std::filesystem::path path;
  std::shared_ptr<const PacketFile> file;
  std::shared_ptr<const RecordingSurvey> recording;  ///< null: a capture
  std::shared_ptr<const PacketDecoder> decoder;      ///< null: unknown sensor
  std::map<std::string, PacketSource> sources;       ///< by "192.168.1.201:2368" or topic
  DatagramCounts counts;
};

/// Converts times of a sensor to nanoseconds since 1970. The part that packets omit (Velodyne: the
/// hour) comes from the capture time of the first packet. So does the whole time if the sensor's
/// clock is more than a minute off, such as one that counts from power-on.
class SensorClock {
 public:
  explicit SensorClock(bool is_hourly) : is_hourly_(is_hourly) {}
  /// Time of a packet's first column. Errors: data (jumps of more than a second; `what` names the
  /// packet).
  std::int64_t time_ns(std::int64_t sensor_ns, std::uint64_t captured_ns, const std::string& what);
  std::int64_t shift_ns() const { return shift_ns_; }

 private:
  bool is_hourly_, has_begun_ = false;
  std::int64_t shift_ns_ = 0, last_ns_ = 0;
  std::uint64_t last_captured_ns_ = 0;
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
bool is_read_by_packets(const RecordingSurvey& survey, const DriveSettings& settings);

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

/// Opens the revolutions of a capture or recording as the scans of a drive, in the sensor frame, as
/// measured. Poses are those of the given trajectory at the middles of the revolutions (or one per
/// revolution, without times); in a recording also those of open_recording_drive(). Revolutions
/// without poses or points are skipped. Errors: usage (no trajectory, an unknown sensor, several
/// sources and no `topic`), data (no packets of the sensor), those of survey_packets() and
/// open_sensor_frames().
KittiSequence open_packet_drive(const DriveInput& drive, const PacketSurvey& survey,
                                const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
