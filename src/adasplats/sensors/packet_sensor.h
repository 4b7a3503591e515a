// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// What the packets of a format are, whichever unit sends them.
struct PacketFacts {
  std::size_t lasers = 0;   ///< 0: any of 16, 32, 64 and 128
  double quantum_m = 0;     ///< of one count of a range
  std::uint32_t most = 0;   ///< counts
  std::size_t columns = 0;  ///< azimuth steps a packet
  std::uint16_t port = 0;   ///< that sensors send to unless told otherwise
};
PacketFacts facts_of_packets(PacketFormat format);

/// A sensor whose packets are known: lasers are beams by their maker's numbers, rings beams from
/// the topmost.
struct PacketSensor {
  PacketFormat format = PacketFormat::vlp_16;
  PacketFacts facts;
  LidarModel model;
  std::vector<std::uint16_t> ring_of_laser, laser_of_ring;
  /// One a ring: added to a packet's range it counts from where the beam leaves, m.
  std::vector<double> range_offsets_m;

  std::size_t lasers() const { return ring_of_laser.size(); }
  /// Bytes of a packet's payload.
  std::size_t payload_bytes() const;
};

/// Errors: usage (a sensor of which no packets are known, with those of the library that have some;
/// another number of beams than the format has; beams that do not turn clockwise).
PacketSensor packet_sensor(const LidarModel& model);

/// What a sensor measured with one laser.
struct PacketReturn {
  std::uint32_t counts = 0;     ///< range in PacketFacts::quantum_m; 0: nothing came back
  std::uint16_t intensity = 0;  ///< share of the highest, from 0 to 65535
};

/// The file that an unmodified driver needs to know this unit, and its name.
struct CalibrationFile {
  std::string name;
  std::string text;
};

/// Velodyne: calibration.yaml as the ROS driver velodyne_pointcloud reads it. Ouster: metadata.json
/// as its SDK does.
CalibrationFile calibration_file(const PacketSensor& sensor);

}  // namespace adasplats
