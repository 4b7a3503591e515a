// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {

/// The measurements at one azimuth step.
struct PacketColumn {
  std::uint64_t time_ns = 0;              ///< of the first laser, since 1970
  std::uint32_t column = 0;               ///< azimuth step, below LidarModel::columns
  std::uint16_t frame = 0;                ///< number of the revolution
  std::span<const PacketReturn> returns;  ///< by laser
};

/// The sensor as encode_packet() writes its packets: `facts` of written ones (Hesai's ranges in
/// steps of 4 mm, the most columns of a packet with one return). Errors: those of packet_sensor();
/// usage (a format that is read only, with those that are written).
PacketSensor written_sensor(const LidarModel& model);
/// Time between the columns of a Hesai, s.
double written_column_s(PacketFormat format);

/// The payload of one packet of a written_sensor() in the sensor's mode for the strongest return.
/// `columns` holds PacketFacts::columns columns in order; `packet_index` counts the packets (the
/// status bytes of an HDL-64E cycle).
std::string encode_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns,
                          std::uint64_t packet_index);

}  // namespace adasplats
