// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/written_rig.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/yaw_pitch_roll.h"
#include "adasplats/dataset/driver_cloud.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

std::string sender_text(const UdpEndpoint& sender) {
  std::string text;
  for (const std::uint8_t byte : sender.address)
    text += (text.empty() ? "" : ".") + std::to_string(byte);
  return text + ":" + std::to_string(sender.port);
}

/// Where the scans of a sensor are, and how to read them.
DriveSettings reading_of(const SimulateJob& job, const RigWriterSensor& sensor,
                         const DriveSettings& given, const fs::path& folder) {
  DriveSettings reading;
  reading.packet_sensor = given.packet_sensor;
  std::error_code ignored;
  if (fs::is_regular_file(given.packet_sensor, ignored))
    reading.packet_sensor = fs::absolute(given.packet_sensor).string();
  // PandaSet's files contain the poses of the LiDAR.
  if (job.format == ScanFormat::pandaset) return reading;
  reading.trajectory = folder / "poses.csv";
  reading.mount = given.mount.value_or(Vec3d{});
  reading.mount_rotation_deg = given.mount_rotation_deg;
  reading.time_offset_s = sensor.time_offset_s;
  if (job.format == ScanFormat::pcap) return reading;
  if (job.driver != CloudDriver::adasplats) {
    const RigidTransform frame =
        sensor.mount * sensor_from_frame(job.driver, *sensor.writing.packets.sensor);
    reading.mount = frame.translation;
    reading.mount_rotation_deg = yaw_pitch_roll_deg(frame.rotation);
  }
  constexpr std::array kTimed = {ScanFormat::ply, ScanFormat::npz, ScanFormat::pcd,
                                 ScanFormat::las, ScanFormat::laz, ScanFormat::mcap};
  // Motion without times remains unstated: such scans cannot be calibrated as a rig.
  const bool is_raw = sensor.writing.drive.turn_s > 0 && job.scan.frame == PointFrame::raw;
  if (!is_raw)
    reading.sweep_points = SweepPoints::compensated;
  else if (std::ranges::find(kTimed, job.format) != kTimed.end())
    reading.sweep_points = SweepPoints::measured;
  if (job.format == ScanFormat::mcap)
    reading.topic = rig_topic(sensor.name, job.driver);
  else
    reading.scan_times = folder / (sensor.name + ".times");
  reading.points_in = PointsIn::sensor;
  return reading;
}

}  // namespace

std::optional<UdpEndpoint> sender_of(const Rig& rig, std::size_t sensor) {
  const std::string& topic = rig.sensors[sensor].topic;
  if (topic.empty()) return std::nullopt;
  const std::size_t colon = topic.find(':');
  const auto port = parse_number<std::uint16_t>(
      colon == std::string::npos ? std::string() : topic.substr(colon + 1));
  UdpEndpoint sender = factory_sender(port.value_or(0));
  std::istringstream address(topic.substr(0, colon));
  std::size_t bytes = 0;
  for (std::string part; std::getline(address, part, '.') && bytes < sender.address.size();
       ++bytes) {
    const auto byte = parse_number<std::uint8_t>(part);
    if (!byte) break;
    sender.address[bytes] = *byte;
  }
  if (port && *port > 0 && sender_text(sender) == topic) return sender;
  throw Error(ErrorKind::usage, rig.file.string() + ": sensor '" + rig.sensors[sensor].name +
                                    "': topic is '" + topic +
                                    "'; packets need ADDRESS:PORT, such as 192.168.1.201:2368");
}

void write_written_rig(const fs::path& folder, const Rig& rig, const SimulateJob& job,
                       const std::vector<RigWriterSensor>& sensors, const ScanWriter& writer,
                       ProgressSink& progress) {
  const fs::path output = fs::absolute(job.output);
  std::vector<UdpEndpoint> senders;
  if (job.format == ScanFormat::pcap) senders = rig_senders(sensors);
  Rig written = rig;
  written.file = output / "rig.toml";
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    RigSensor& sensor = written.sensors[k];
    static_cast<DriveSettings&>(sensor) = reading_of(job, sensors[k], rig.sensors[k], output);
    if (job.format == ScanFormat::mcap) {
      sensor.folder = output / "scans.mcap";
    } else if (job.format == ScanFormat::pcap) {
      sensor.folder = output / "drive.pcap";
      sensor.topic = sender_text(senders[k]);
    } else {
      const std::string scan = writer.main_file(rig_scan_number(0, k, sensors.size()));
      sensor.folder = (output / scan).parent_path();
      if (job.format == ScanFormat::pandaset) sensor.folder = sensor.folder.parent_path();
    }
  }
  // Mounts are those of `rig`, except where the scans contain the poses of each sensor.
  if (!written.sensors.front().given_mount() && !move_to_frame_of(sensors.front().mount, written))
    progress.warn((output / "rig.toml").string() +
                  ": has no `body`: pandaset has the poses of the sensors only, and sensor '" +
                  written.sensors.front().name + "' is turned against the vehicle");
  write_file_in_place(folder / "rig.toml", rig_toml(written));
}

}  // namespace adasplats
