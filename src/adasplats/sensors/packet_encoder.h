// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {

/// All that a sensor measures at one azimuth step.
struct PacketColumn {
  std::uint64_t time_ns = 0;              ///< since 1970, when its first laser fires
  std::uint32_t column = 0;               ///< azimuth step, below LidarModel::columns
  std::uint16_t frame = 0;                ///< revolution
  std::span<const PacketReturn> returns;  ///< by laser
};

/// The payload of one packet, as the sensor sends it for its strongest return. `columns` are
/// PacketFacts::columns in their order; `packet_index` counts the packets (the status bytes of an
/// HDL-64E take turns).
std::string encode_packet(const PacketSensor& sensor, std::span<const PacketColumn> columns,
                          std::uint64_t packet_index);

}  // namespace adasplats
