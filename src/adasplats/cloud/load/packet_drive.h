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
#include "adasplats/core/progress.h"
#include "adasplats/io/packets/datagram_reader.h"
#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {

/// One turn of a sensor's head in a capture.
struct Revolution {
  CapturePlace place;         ///< of the packet that it begins in
  std::size_t skipped = 0;    ///< columns of that packet that are of the one before
  std::size_t columns = 0;    ///< that were captured
  double share = 0;           ///< of a turn, from its first column to its last one
  std::int64_t begin_ns = 0;  ///< when its first column was measured, since 1970
  std::int64_t end_ns = 0;    ///< when its last one ended
  bool has_points = false;
};

/// The datagrams that came from one address to one port.
struct PacketSource {
  std::uint64_t datagrams = 0;
  std::uint64_t packets = 0;                 ///< of the sensor
  std::uint64_t dual_packets = 0;            ///< of them, with two returns a firing
  std::uint64_t gaps = 0, lost_columns = 0;  ///< where packets are missing
  std::string objection;                     ///< why datagrams of their size are none; empty: none
  std::int64_t ahead_ns = 0;  ///< the clock of the capture less the sensor's, before ahead_ns
  std::vector<Revolution> revolutions;
};

/// A capture that was read once.
struct PacketSurvey {
  std::filesystem::path path;
  std::shared_ptr<const PacketDecoder> decoder;  ///< null: the sensor is not known
  std::map<std::string, PacketSource> sources;   ///< by "192.168.1.201:2368"
  DatagramCounts counts;
};

/// Times of a sensor as nanoseconds since 1970: what its packets leave out (Velodyne: the hour) is
/// that of the capture when the first one was captured, and so is all of it where the sensor's
/// clock is more than a minute off, as one that counts since it was switched on.
class SensorClock {
 public:
  explicit SensorClock(bool is_hourly) : is_hourly_(is_hourly) {}
  /// Of a packet's first column. Errors: data (jumps of more than a second, with `what`).
  std::int64_t time_ns(std::int64_t sensor_ns, std::uint64_t captured_ns, const std::string& what);
  std::int64_t shift_ns() const { return shift_ns_; }

 private:
  bool is_hourly_, has_begun_ = false;
  std::int64_t shift_ns_ = 0, last_ns_ = 0;
  std::uint64_t last_captured_ns_ = 0;
};

/// Reads a capture from front to back and finds the revolutions of a sensor in it: Ouster's by
/// their numbers; Velodyne's end where the head passes the first azimuth of the sensor file, or
/// where that is 0, and so nobody said where, the azimuth that the capture begins at, so that all
/// but the last are whole. After a gap of half a turn or more that is the azimuth behind it.
/// Without `decoder` it counts datagrams alone. Memory: 90 bytes a revolution. Errors: those of
/// DatagramReader; data (more than 256 sources; a sensor's clock that jumps).
PacketSurvey survey_packets(const std::filesystem::path& path,
                            std::shared_ptr<const PacketDecoder> decoder, ProgressSink& progress);

/// The sensor of a capture: `stated`, else the one file of a maker beside it: STEM.json,
/// metadata.json, calibration*.yaml. Empty: there is none. Errors: usage (several).
std::string sensor_of_capture(const std::filesystem::path& capture, const std::string& stated);

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
