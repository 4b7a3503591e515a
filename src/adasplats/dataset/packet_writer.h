// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/dataset/scan_writer.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/sensors/packet_encoder.h"
#include "adasplats/sensors/packet_sensor.h"

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

/// The packets of one sensor, scan after scan.
class PacketStream {
 public:
  /// Not used: `begin_after_s` and `shift_s` of the options. Errors: usage (require_packets()).
  PacketStream(const PacketOptions& options, PacketSink sink);

  const PacketSensor& sensor() const { return sensor_; }
  double turn_s() const { return turn_s_; }
  /// What the firings of a scan returned, column by column. Thread-safe.
  std::vector<PacketReturn> returns_of(const ScanView& scan) const;
  /// Sends a revolution that begins at `begin_s` since 1970. If that is where the last one ended,
  /// the open packet continues; else it is filled first. Errors: data (before 1970, or by more than
  /// a twentieth of a revolution before the last one ended).
  void add(double begin_s, std::span<const PacketReturn> returns);
  /// Fills the open packet with columns without returns and sends it.
  void flush();

 private:
  PacketReturn return_of(const ScanView& scan, std::size_t i, double offset_m) const;
  void require_time(double begin_s) const;
  void add_column(double begin_s, std::uint32_t column, std::span<const PacketReturn> returns);
  void send();

  PacketOptions options_;
  PacketSensor sensor_;
  UdpEndpoint sender_;
  PacketSink sink_;
  double turn_s_, column_s_;
  std::vector<PacketReturn> nothing_;
  std::optional<double> end_s_;  ///< of the last scan
  std::uint64_t scans_ = 0, packets_ = 0, sent_us_ = 0;
  std::vector<PacketColumn> columns_;              ///< of the open packet
  std::deque<std::vector<PacketReturn>> returns_;  ///< of these columns
};

/// Where a sensor of factory settings sends from.
UdpEndpoint factory_sender(std::uint16_t port);

}  // namespace adasplats
