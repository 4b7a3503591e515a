// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/dataset/driver_cloud.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/io/packets/capture_sender.h"
#include "adasplats/live/live_rig.h"
#include "adasplats/live/message_server.h"
#include "adasplats/live/pacer.h"

namespace adasplats {

/// Where packets go, one port a sensor.
struct PacketTarget {
  std::string host;
  std::vector<std::uint16_t> ports;
};

/// Sends what a rig measures: packets over UDP at the time at which the sensor sends them, and
/// messages of ROS 2 for a MessageServer: /clock, /tf (base_link in map), /tf_static (sensors in
/// base_link), and the clouds of a driver at the end of a revolution.
class LiveStreams {
 public:
  /// Errors: usage (a begin before 0, which messages and packets cannot represent; a sensor
  /// without packets or without clouds of the driver), no_input (unknown host).
  LiveStreams(const LiveRig& rig, const std::optional<PacketTarget>& target,
              CloudDriver driver = CloudDriver::adasplats);

  MessageServer& messages() { return *messages_; }
  const MessageServer& messages() const { return *messages_; }
  bool has_packets() const { return sender_ != nullptr; }
  /// Of a sensor with packets.
  const PacketSensor& packet_sensor(std::size_t sensor) const {
    return packets_.at(sensor)->sensor();
  }
  std::string topic(std::size_t sensor) const;
  /// The pose of the frame of a sensor's points in that of the vehicle.
  RigidTransform vehicle_from_points(std::size_t sensor) const {
    return rig_.sensors()[sensor].mount * clouds_[sensor].sensor_from_points();
  }
  std::uint16_t port(std::size_t sensor) const { return ports_.at(sensor); }
  std::uint64_t packets_sent() const { return packets_sent_; }
  std::uint64_t packets_failed() const { return packets_failed_; }

  /// Receives a time of the simulation and what to do then.
  using Schedule = std::function<void(double time_s, std::function<void()> action)>;
  /// Encodes a step and schedules its parts. Errors: those of PacketStream and of the messages.
  void send(const LiveStep& step, const Schedule& schedule);

 private:
  std::string mounts_message() const;
  void send_points(const LiveScan& live, const Schedule& schedule);
  void send_poses(const LiveStep& step, const Schedule& schedule);
  void send_packet(std::string_view payload, std::uint16_t port);

  const LiveRig& rig_;
  CloudDriver driver_;
  std::vector<DriverClouds> clouds_;  ///< by sensor
  std::unique_ptr<MessageServer> messages_;
  std::unique_ptr<DatagramSender> sender_;
  std::vector<std::unique_ptr<PacketStream>> packets_;  ///< by sensor
  std::vector<std::uint16_t> ports_;                    ///< likewise
  const Schedule* schedule_ = nullptr;                  ///< of the step that is being sent
  std::atomic<std::uint64_t> packets_sent_ = 0, packets_failed_ = 0;
};

}  // namespace adasplats
