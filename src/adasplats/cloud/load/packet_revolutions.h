// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/packet_file.h"
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
  std::int64_t ahead_ns = 0;  ///< of the capture's clock before the sensor's, at the start
  std::vector<Revolution> revolutions;
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

/// Cuts the columns of one source into revolutions.
class RevolutionFinder {
 public:
  RevolutionFinder(const PacketDecoder& decoder, PacketSource& source);

  void add(const SensorPacket& packet, const std::string& what);

 private:
  std::int64_t turn_ns() const;
  /// The step at which revolutions begin, if this column is the first.
  std::uint32_t cut_before(const MeasuredColumn& column) const;
  std::uint32_t since_cut(const MeasuredColumn& column) const;
  /// The head passed the end of a turn, or went back (packets are missing).
  bool begins_revolution(const MeasuredColumn& column) const;
  /// Counts numbered revolutions whose end contradicts the columns per revolution: by the time
  /// since the last column, another number of columns is missing up to this one.
  void check_turn(const MeasuredColumn& column, std::int64_t time_ns);
  double share_of_turn(const MeasuredColumn& last) const;
  void count_gap(const MeasuredColumn& column, std::int64_t time_ns, bool within_packet);
  /// Whether the head passed angles at which the sensor is set not to measure: a jump within a
  /// packet, later one between packets at the same angles too.
  bool is_pause(const MeasuredColumn& column, bool within_packet);
  /// How many of the columns after the last one are in the window of an Ouster.
  std::uint64_t columns_of_window(std::int64_t missing) const;

  const PacketDecoder& decoder_;
  PacketSource& source_;
  SensorClock clock_;
  std::int64_t column_ns_, last_ns_ = 0;
  std::uint32_t cut_step_ = 0, first_step_ = 0;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> pause_;  ///< its ends, steps
  MeasuredColumn last_;
};

}  // namespace adasplats
