// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Constants of a packet format.
struct PacketFacts {
  std::size_t lasers = 0;  ///< 0: any of 16, 32, 64 and 128
  double quantum_m = 0;    ///< one count of a range
  std::uint32_t max_counts = 0;
  std::size_t columns = 0;  ///< azimuth steps per packet; 0: depends on the packet
  std::uint16_t port = 0;   ///< default UDP port
};
PacketFacts facts_of_packets(PacketFormat format);

inline constexpr std::uint16_t kNoRing = 0xFFFF;

/// A sensor with a supported packet format. Lasers are beams in the manufacturer's order, rings are
/// beams from the topmost down.
struct PacketSensor {
  PacketFormat format = PacketFormat::vlp_16;
  PacketFacts facts;
  LidarModel model;
  /// ring_of_laser is kNoRing for positions without a beam.
  std::vector<std::uint16_t> ring_of_laser, laser_of_ring;
  /// One a ring, m; added to a packet's range, which then starts at the origin of the beam.
  std::vector<double> range_offsets_m;
  /// A VLP-16 whose packets state the HDL-32E in their factory bytes, as those of 2014.
  bool states_hdl_32e = false;

  std::size_t lasers() const { return ring_of_laser.size(); }
  /// Null but for an AT128.
  const MirrorAngles* mirror() const { return model.packets->mirror.get(); }
  std::size_t payload_bytes() const;
  double column_s() const { return 1.0 / (model.rotation_hz * model.columns); }
};

/// Errors: usage (a sensor without a supported packet format, with those of the library that have
/// one; a wrong number of beams for the format; counter-clockwise rotation).
PacketSensor packet_sensor(const LidarModel& model);

/// One return of one laser.
struct PacketReturn {
  std::uint32_t counts = 0;     ///< range in PacketFacts::quantum_m; 0: no return
  std::uint16_t intensity = 0;  ///< 65535: the maximum
};

/// The calibration file of this sensor for an unmodified driver, and its name.
struct CalibrationFile {
  std::string name;
  std::string text;
};

/// Velodyne: calibration.yaml for the ROS driver velodyne_pointcloud. Ouster: metadata.json for its
/// SDK. Hesai: the angle correction file. Errors: usage (a sensor that the file cannot represent).
CalibrationFile calibration_file(const PacketSensor& sensor);

}  // namespace adasplats
