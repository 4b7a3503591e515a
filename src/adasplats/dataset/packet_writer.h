// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "adasplats/dataset/scan_writer.h"
#include "adasplats/io/packets/capture_writer.h"

namespace adasplats {

/// Throws usage, with the reason, if scans of a sensor cannot be written as its packets.
void require_packets(const LidarModel& sensor, const PacketOptions& options);

/// Writes FOLDER/drive.pcap (CaptureWriter): the packets that the sensor sends during the scans,
/// with its own laser numbers, for beams with and without returns; the calibration file for its
/// driver (calibration_file()); and poses.csv with the times of the middles of the revolutions, as
/// in the packets. If a scan begins when the last one ended, the packet continues; otherwise it is
/// filled with columns without returns. If the first scan would begin before 1970, all times are
/// shifted by an hour. Needs ScanWriterOptions::packets. Errors: usage (require_packets()); data
/// (scans that begin before 1970, or by more than a twentieth of a revolution before the last one
/// ended); cannot_create, io.
std::unique_ptr<ScanWriter> make_packet_writer(const std::filesystem::path& folder,
                                               const ScanWriterOptions& options);

/// Receives the packets of a sensor; times since 1970 ascend.
using PacketSink = std::function<void(std::uint64_t time_us, const UdpEndpoint& from,
                                      const UdpEndpoint& to, std::string payload)>;
/// The same without a capture of its own: the packets go to `sink`, in append() and finish().
std::unique_ptr<ScanWriter> make_packet_writer(const std::filesystem::path& folder,
                                               const ScanWriterOptions& options, PacketSink sink);
/// Where a sensor of factory settings sends from.
UdpEndpoint factory_sender(std::uint16_t port);

}  // namespace adasplats
