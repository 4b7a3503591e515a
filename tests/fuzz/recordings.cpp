// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/packet_drive.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/bags/ros_values.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/io/packets/datagram_reader.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/packet_decoder.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {
namespace {

std::shared_ptr<const PacketDecoder> decoder_named(const char* name) {
  return std::make_shared<const PacketDecoder>(packet_sensor(load_lidar_model(name)));
}

/// The first byte of an input, and the rest.
std::pair<std::uint8_t, std::string_view> chosen(std::string_view bytes) {
  if (bytes.empty()) return {0, bytes};
  return {static_cast<std::uint8_t>(bytes[0]), bytes.substr(1)};
}

}  // namespace

void read_recording(const Input& input) {
  if (input.file.extension() == ".mcap")
    read_mcap_metadata(input.file, kMcapMetadataName, kMcapLabelsKey);
  const Recording recording(input.file);
  constexpr std::size_t kAgain = 8;
  std::vector<std::pair<MessagePosition, std::string>> first;
  recording.for_each_message([&](const RecordedMessage& message) {
    if (first.size() < kAgain) first.emplace_back(message.place, message.bytes);
  });
  for (const auto& [place, bytes] : first)
    require(recording.message(place) == bytes, "the same message again");
}

void read_bag_folder(const Input& input) {
  require(is_recording(input.folder) || !input.bytes.starts_with("rosbag2_bagfile_information"),
          "a folder with such a file is a recording");
  Input folder = input;
  folder.file = input.folder;
  read_recording(folder);
}

void read_ros_message(const Input& input) {
  const auto [choice, bytes] = chosen(input.bytes);
  const MessageEncoding encoding = (choice & 1) != 0 ? MessageEncoding::cdr : MessageEncoding::ros1;
  constexpr std::array kTypes = {kRosTransforms, kRosOdometry, kRosPose, kRosTransform};
  const std::size_t type = choice >> 1;
  if (type < kTypes.size()) {
    require(ros_poses(bytes, kTypes[type], encoding, "m").size() <= bytes.size(),
            "no more poses than bytes");
    return;
  }
  constexpr std::array<std::string_view, 6> kPacketTypes = {
      "velodyne_msgs/VelodyneScan", "nebula_msgs/NebulaPackets", "pandar_msgs/PandarScan",
      "hesai_ros_driver/UdpFrame",  "ouster_ros/PacketMsg",      kRosString};
  const std::size_t after_cloud = type - kTypes.size() - 1;
  if (type > kTypes.size() && after_cloud < kPacketTypes.size()) {
    const std::string_view packets = kPacketTypes[after_cloud];
    if (packets == kRosString)
      require(ros_string(bytes, encoding, "m").size() <= bytes.size(),
              "no text beyond the message");
    else
      for (const RosPacket& packet : ros_packets(bytes, packets, encoding, "m").packets)
        require(packet.bytes.size() <= bytes.size(), "no packet beyond the message");
    return;
  }
  const RosCloudHead head = ros_cloud_head(bytes, encoding, "m");
  const Table table = ros_points(bytes, encoding, "m");
  require_sound(table, bytes.size());
  require(table.rows == head.points, "as many points as the head says");
}

void read_packed_bytes(const Input& input) {
  const auto [choice, bytes] = chosen(input.bytes);
  constexpr std::array kPackings = {"zstd", "lz4", "bz2"};
  constexpr std::size_t kSize = 1000;
  if (choice < kPackings.size()) {
    require(unpack(kPackings[choice], bytes, kSize, "m").size() == kSize, "the size that is asked");
  } else if (choice == kPackings.size()) {
    unpack_sized("zstd", bytes, "m");
  } else {
    std::string_view rest = bytes;
    unpack_zstd_stream(
        [&](std::size_t used) {
          rest.remove_prefix(used);
          return rest;
        },
        [](std::string_view) {}, "m");
  }
}

void survey_clouds(const Input& input) {
  ProgressSink quiet;
  const RecordingSurvey survey = survey_recording(input.file, quiet);
  for (const auto& [name, topic] : survey.topics)
    require(topic.clouds.size() <= topic.messages, "no more clouds than messages");
  DriveSettings settings;
  if (is_read_by_packets(survey, settings)) {
    settings.packet_sensor = "velodyne-vlp-16";
    for (const auto& [name, source] : survey_packets(survey, settings, quiet).sources)
      require(source.packets <= source.datagrams, "no more packets than datagrams");
  }
  const RecordedTrajectory found = trajectory_of_recording(input.file, "", "", quiet);
  for (std::size_t k = 1; k < found.motion.size(); ++k)
    require(found.motion[k].time_s > found.motion[k - 1].time_s, "times that ascend");
}

void read_capture(const Input& input) {
  DatagramReader reader(input.file);
  CapturePosition place;
  std::string first;
  std::uint64_t datagrams = 0;
  while (const auto datagram = reader.next()) {
    require(datagram->payload.size() <= input.bytes.size(), "no payload larger than the file");
    if (datagrams++ > 0) continue;
    place = datagram->place;
    first = datagram->payload;
  }
  require(reader.counts().datagrams == datagrams, "datagrams that are counted");
  if (datagrams == 0) return;
  DatagramReader again(input.file, place);
  require(again.next()->payload == first, "the same datagram again");
}

void read_packet(const Input& input) {
  static const std::array kDecoders = {decoder_named("velodyne-vlp-16"),
                                       decoder_named("velodyne-hdl-32e"),
                                       decoder_named("velodyne-hdl-64e-kitti"),
                                       decoder_named("velodyne-vls-128"),
                                       decoder_named("ouster-os1-64"),
                                       decoder_named("ouster-os1-128"),
                                       decoder_named("hesai-pandar64"),
                                       decoder_named("hesai-pandarxt-32"),
                                       decoder_named("hesai-ot128")};
  const auto [choice, bytes] = chosen(input.bytes);
  const PacketDecoder& decoder = *kDecoders[choice % kDecoders.size()];
  // Any payload that is too short is padded: the reader takes those of the right size alone.
  std::string payload(bytes);
  payload.resize(decoder.sensor().payload_bytes());
  if (decoder.objection(payload) || decoder.contradiction(payload)) return;
  const std::vector<MeasuredColumn> columns = decoder.columns(payload);
  PacketPoints points;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    decoder.has_returns(payload, k);
    if (columns[k].is_valid) decoder.add_points(payload, k, columns[k], points);
  }
  require(points.late_s.size() == points.positions.size() &&
              points.intensities.size() == points.positions.size() &&
              points.rings.size() == points.positions.size(),
          "values of every point");
  for (const std::uint16_t ring : points.rings)
    require(ring < decoder.sensor().lasers(), "rings of the sensor");
}

void survey_capture(const Input& input) {
  static const auto kDecoder = decoder_named("velodyne-vlp-16");
  ProgressSink quiet;
  const PacketSurvey survey = survey_packets(input.file, kDecoder, quiet);
  for (const auto& [name, source] : survey.sources)
    require(source.packets <= source.datagrams, "no more packets than datagrams");
}

}  // namespace adasplats::fuzz
