// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Throws usage where scans of a sensor cannot be its packets: packets_fit() says which.
void require_packets(const LidarModel& sensor, const PacketOptions& options);

/// FOLDER/drive.pcap (CaptureWriter): the packets that the sensor sends while it makes the scans,
/// laser by laser in its own numbers, with and without returns; the calibration that its driver
/// needs (calibration_file()); and poses.csv with the times of the middles of the revolutions, as
/// the packets have them. Where a scan begins when the last one ended, a packet goes on; else the
/// head turns on without returns until its packet is full. Where the first one would begin before
/// 1970, all times are an hour later. Needs ScanWriterOptions::packets.
/// Errors: usage (require_packets()); data (scans that begin before 1970, or by more than a
/// twentieth of a revolution before the last one ended); cannot_create, io.
std::unique_ptr<ScanWriter> make_packet_writer(const std::filesystem::path& folder,
                                               const ScanWriterOptions& options);

}  // namespace adasplats
