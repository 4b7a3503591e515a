// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/live_streams.h"

#include <cmath>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/dataset/rig_writer.h"
#include "adasplats/dataset/ros_messages.h"

namespace adasplats {
namespace {

/// Channels; those of the points follow, by sensor.
constexpr std::size_t kClockChannel = 0, kPosesChannel = 1, kMountsChannel = 2, kPointsChannel = 3;
constexpr double kClockStep_s = 0.01;
/// Of a client that is behind; more than a scan of 128 beams.
constexpr std::size_t kQueueBytes = std::size_t{32} << 20;

std::vector<MessageServer::Channel> channels_of(const LiveRig& rig, CloudDriver driver) {
  std::vector<MessageServer::Channel> channels;
  channels.push_back({ros_channel("/clock", kClockType, clock_definition())});
  channels.push_back({ros_channel("/tf", kTransformsType, transforms_definition())});
  channels.push_back({ros_channel("/tf_static", kTransformsType, transforms_definition()), true});
  for (const MountedSensor& sensor : rig.sensors())
    channels.push_back(
        {ros_channel(rig_topic(sensor.name, driver), kPointCloud2Type, point_cloud2_definition())});
  return channels;
}

PacketOptions packet_options_of(const LiveRig& rig, const MountedSensor& mounted) {
  PacketOptions packets;
  packets.sensor = &mounted.settings.sensor;
  packets.returns = mounted.settings.beam.returns;
  packets.mode = mounted.settings.beam.mode;
  packets.has_angular_noise = mounted.settings.noise;
  packets.is_raw = mounted.settings.frame == PointFrame::raw;
  packets.full_intensity = scale_of_intensities(rig.scene());
  packets.time_offset_s = mounted.time_offset_s;
  return packets;
}

}  // namespace

LiveStreams::LiveStreams(const LiveRig& rig, const std::optional<PacketTarget>& target,
                         CloudDriver driver)
    : rig_(rig),
      driver_(driver),
      messages_(
          std::make_unique<MessageServer>("adasplats", channels_of(rig, driver), kQueueBytes)) {
  for (const MountedSensor& sensor : rig.sensors()) {
    if (rig.time_s() < 0 || rig.time_s() - sensor.time_offset_s < 0)
      throw Error(ErrorKind::usage, "the drive begins at " + std::to_string(rig.time_s()) +
                                        " s; messages and packets have no times before 0, also "
                                        "in the clock of sensor '" +
                                        sensor.name + "'");
    clouds_.emplace_back(driver, packet_options_of(rig, sensor));
  }
  messages_->publish(kMountsChannel, ros_time_ns(rig.time_s()), mounts_message());
  if (!target) return;
  sender_ = std::make_unique<DatagramSender>(target->host);
  ports_ = target->ports;
  for (std::size_t k = 0; k < rig.sensors().size(); ++k) {
    const auto sink = [this](std::uint64_t time_us, const UdpEndpoint& /*from*/,
                             const UdpEndpoint& to, std::string payload) {
      constexpr double kMicrosecond_s = 1e-6;
      (*schedule_)(
          kMicrosecond_s * static_cast<double>(time_us),
          [this, bytes = std::move(payload), port = to.port] { send_packet(bytes, port); });
    };
    PacketOptions options = packet_options_of(rig, rig.sensors()[k]);
    options.sender = factory_sender(target->ports.at(k));
    packets_.push_back(std::make_unique<PacketStream>(options, sink));
  }
}

std::string LiveStreams::topic(std::size_t sensor) const {
  return rig_topic(rig_.sensors()[sensor].name, driver_);
}

std::string LiveStreams::mounts_message() const {
  std::vector<RosTransform> mounts;
  for (std::size_t k = 0; k < clouds_.size(); ++k)
    mounts.push_back(
        {{rig_.time_s(), vehicle_from_points(k)}, kRosVehicleFrame, rig_.sensors()[k].name});
  return transforms_message(mounts);
}

void LiveStreams::send_packet(std::string_view payload, std::uint16_t port) {
  try {
    sender_->send(payload, port, WhenFull::fail);
    ++packets_sent_;
  } catch (const Error&) {
    ++packets_failed_;
  }
}

void LiveStreams::send_points(const LiveScan& live, const Schedule& schedule) {
  const std::size_t channel = kPointsChannel + live.sensor;
  if (!messages_->is_wanted(channel)) return;
  const MountedSensor& sensor = rig_.sensors()[live.sensor];
  ScanView scan = *live.scan;
  const double end_s = scan.begin_s() + scan.duration_s;
  scan.time_s -= sensor.time_offset_s;
  schedule(end_s, [this, channel, time_ns = ros_time_ns(end_s),
                   message = clouds_[live.sensor].message(scan, sensor.name, 0)] {
    messages_->publish(channel, time_ns, message);
  });
}

void LiveStreams::send_poses(const LiveStep& step, const Schedule& schedule) {
  const long ticks = std::lround(step.duration_s / kClockStep_s);
  for (long i = 1; i <= ticks; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(ticks);
    const double time_s = step.begin_s + share * step.duration_s;
    schedule(time_s, [this, time_ns = ros_time_ns(time_s), message = clock_message(time_s)] {
      messages_->publish(kClockChannel, time_ns, message);
      messages_->publish_time(time_ns);
    });
  }
  for (TimedPose pose : step.vehicle) {
    // The next step begins at the time of the last pose, where a request may have put the vehicle;
    // tf2 keeps one pose of a time.
    constexpr double kJustBefore_s = 1e-6;
    if (pose.time_s == step.vehicle.back().time_s) pose.time_s -= kJustBefore_s;
    const RosTransform transform = {pose, kRosWorldFrame, kRosVehicleFrame};
    schedule(pose.time_s, [this, time_ns = ros_time_ns(pose.time_s),
                           message = transforms_message({&transform, 1})] {
      messages_->publish(kPosesChannel, time_ns, message);
    });
  }
}

void LiveStreams::send(const LiveStep& step, const Schedule& schedule) {
  send_poses(step, schedule);
  schedule_ = &schedule;
  for (const LiveScan& live : step.scans) {
    if (has_packets()) {
      const ScanView scan = *live.scan;
      PacketStream& packets = *packets_[live.sensor];
      packets.add(scan.begin_s(), packets.returns_of(scan));
    }
    send_points(live, schedule);
  }
}

}  // namespace adasplats
