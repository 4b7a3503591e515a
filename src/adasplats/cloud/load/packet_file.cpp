// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_file.h"

#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/ros_values.h"

namespace adasplats {
namespace {

Error changed_file(const std::filesystem::path& path) {
  return {ErrorKind::io, path.string() + ": changed while it was read"};
}

class CapturePackets final : public PacketFile {
 public:
  explicit CapturePackets(std::filesystem::path path) : path_(std::move(path)) {}

  DatagramCounts for_each(FunctionRef<void(const SensorPacket&)> visit) const override {
    DatagramReader reader(path_);
    while (const auto datagram = reader.next())
      visit({datagram->time_ns, source_of(*datagram), datagram->payload, {datagram->place}});
    return reader.counts();
  }
  void read_from(const std::string& source, const PacketPlace& place,
                 FunctionRef<bool(const SensorPacket&)> visit) const override {
    DatagramReader reader(path_, place.capture);
    while (const auto datagram = reader.next())
      if (source_of(*datagram) == source &&
          !visit({datagram->time_ns, source, datagram->payload, {datagram->place}}))
        return;
    throw changed_file(path_);
  }

 private:
  static std::string source_of(const Datagram& datagram) {
    return address_text(datagram.from) + ":" + std::to_string(datagram.to_port);
  }

  std::filesystem::path path_;
};

class RecordedPackets final : public PacketFile {
 public:
  explicit RecordedPackets(std::shared_ptr<const RecordingSurvey> survey)
      : survey_(std::move(survey)) {}

  DatagramCounts for_each(FunctionRef<void(const SensorPacket&)> visit) const override {
    DatagramCounts counts;
    for (const auto& [name, topic] : survey_->topics)
      visit_from(topic, {}, [&](const SensorPacket& packet) {
        ++counts.datagrams;
        visit(packet);
        return true;
      });
    return counts;
  }
  void read_from(const std::string& source, const PacketPlace& place,
                 FunctionRef<bool(const SensorPacket&)> visit) const override {
    if (visit_from(survey_->topics.at(source), place, visit))
      throw changed_file(survey_->recording->path());
  }

 private:
  /// False if `visit` returned false.
  bool visit_from(const TopicSurvey& topic, const PacketPlace& place,
                  FunctionRef<bool(const SensorPacket&)> visit) const {
    const Recording& recording = *survey_->recording;
    std::size_t first = place.in_message;
    for (std::size_t k = place.message; k < topic.packets.size(); ++k) {
      const PacketMessage& message = topic.packets[k];
      const std::string bytes = recording.message(message.place);
      const RosPackets found =
          ros_packets(bytes, topic.topic.type, topic.topic.encoding,
                      recording.path().string() + ": message " + std::to_string(k + 1) +
                          " (from 1) of " + topic.topic.name);
      for (std::size_t i = std::exchange(first, 0); i < found.packets.size(); ++i) {
        const RosPacket& packet = found.packets[i];
        const auto time_ns =
            packet.time_ns > 0 ? static_cast<std::uint64_t>(packet.time_ns) : message.time_ns;
        if (!visit({time_ns, topic.topic.name, packet.bytes, {{}, k, i}})) return false;
      }
    }
    return true;
  }

  std::shared_ptr<const RecordingSurvey> survey_;
};

}  // namespace

std::shared_ptr<const PacketFile> packets_of_capture(const std::filesystem::path& path) {
  return std::make_shared<CapturePackets>(path);
}

std::shared_ptr<const PacketFile> packets_of_recording(
    std::shared_ptr<const RecordingSurvey> survey) {
  return std::make_shared<RecordedPackets>(std::move(survey));
}

}  // namespace adasplats
