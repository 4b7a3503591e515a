// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/rig_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/dataset/camera_messages.h"
#include "adasplats/dataset/driver_cloud.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/dataset/ros_messages.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/sensors/camera.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

Error rig_error(const RigWriterSensor& sensor, const std::string& message) {
  return {ErrorKind::usage, "sensor '" + sensor.name + "' of the rig: " + message};
}

/// The earliest time in the clocks of all sensors and of the vehicle.
double earliest_s(const std::vector<RigWriterSensor>& sensors, const Trajectory& vehicle) {
  double earliest_s = vehicle.front().time_s;
  for (const RigWriterSensor& sensor : sensors) {
    const DriveSpan& drive = sensor.writing.drive;
    const double begin_s = drive.begin_s() - 0.5 * drive.turn_s;
    earliest_s = std::min({earliest_s, begin_s, begin_s - sensor.time_offset_s});
  }
  return earliest_s;
}

/// What all formats share.
class RigWriter : public ScanWriter {
 public:
  RigWriter(const fs::path& folder, std::vector<RigWriterSensor> sensors, Trajectory vehicle)
      : ScanWriter(folder), sensors_(std::move(sensors)), vehicle_(std::move(vehicle)) {}

  std::string main_file(std::size_t /*index*/) const override { return ""; }
  void keep(std::size_t /*index*/, const TimedPose& /*pose*/) override {}
  void finish() override { write_trajectory_csv(folder() / "poses.csv", vehicle_); }

 protected:
  std::size_t sensor_of(std::size_t index) const { return index % sensors_.size(); }
  std::size_t scan_of(std::size_t index) const { return index / sensors_.size(); }
  const std::vector<RigWriterSensor>& sensors() const { return sensors_; }
  const Trajectory& vehicle() const { return vehicle_; }
  void delay_poses(double later_s) {
    for (TimedPose& pose : vehicle_) pose.time_s += later_s;
  }
  /// A scan in the clock of its sensor.
  ScanView in_own_clock(std::size_t index, ScanView scan) const {
    scan.time_s -= sensors_[sensor_of(index)].time_offset_s;
    return scan;
  }

 private:
  std::vector<RigWriterSensor> sensors_;
  Trajectory vehicle_;
};

/// A folder for each sensor.
class RigFolders final : public RigWriter {
 public:
  RigFolders(const fs::path& folder, ScanFormat format, std::vector<RigWriterSensor> all,
             Trajectory vehicle)
      : RigWriter(folder, std::move(all), std::move(vehicle)), times_(sensors().size()) {
    for (const RigWriterSensor& sensor : sensors()) {
      const double offset_s = sensor.time_offset_s;
      ScanWriterOptions writing = sensor.writing;
      for (double& time_s : writing.drive.times_s) time_s -= offset_s;
      if (writing.boxes)
        writing.boxes = [boxes = sensor.writing.boxes, offset_s](std::size_t i, double time_s) {
          return boxes(i, time_s + offset_s);
        };
      create_folder(folder / sensor.name);
      writers_.push_back(make_scan_writer(folder / sensor.name, format, writing));
    }
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded =
        writers_[sensor_of(index)]->encode(scan_of(index), in_own_clock(index, scan));
    for (EncodedFile& file : encoded.files) file.name = name_of(index, file.name);
    return encoded;
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    writers_[sensor_of(index)]->append(scan_of(index), scan);
    times_[sensor_of(index)] += exact_text(scan.pose.time_s) + "\n";
  }
  std::string main_file(std::size_t index) const override {
    return name_of(index, writers_[sensor_of(index)]->main_file(scan_of(index)));
  }
  void keep(std::size_t index, const TimedPose& pose) override {
    const std::size_t k = sensor_of(index);
    const TimedPose own = {pose.time_s - sensors()[k].time_offset_s, pose.world_from_sensor};
    writers_[k]->keep(scan_of(index), own);
    times_[k] += exact_text(own.time_s) + "\n";
  }
  void finish() override {
    for (std::size_t k = 0; k < writers_.size(); ++k) {
      writers_[k]->finish();
      write_file(folder() / (sensors()[k].name + ".times"), times_[k]);
    }
    RigWriter::finish();
  }

 private:
  std::string name_of(std::size_t index, const std::string& file) const {
    return sensors()[sensor_of(index)].name + "/" + file;
  }

  std::vector<std::unique_ptr<ScanWriter>> writers_;
  std::vector<std::string> times_;  ///< of the scans, by sensor
};

class RigMessages final : public RigWriter {
 public:
  RigMessages(const fs::path& folder, std::vector<RigWriterSensor> all, Trajectory poses,
              RigPictures* pictures)
      : RigWriter(folder, std::move(all), std::move(poses)),
        file_(folder / "scans.mcap", "ros2"),
        merged_(sensors().size() + (pictures != nullptr ? 1 : 0)),
        pictures_(pictures),
        later_s_(rig_ros_delay_s(sensors(), vehicle())) {
    const LabelScheme* const labels = sensors().front().writing.labels;
    if (labels != nullptr) file_.add_metadata(kMcapMetadataName, kMcapLabelsKey, labels->name());
    delay_poses(later_s_);
    const double begin_s = vehicle().front().time_s;
    const auto channel = [this](const std::string& topic, bool is_points) {
      return file_.add_channel(is_points
                                   ? ros_channel(topic, kPointCloud2Type, point_cloud2_definition())
                                   : ros_channel(topic, kTransformsType, transforms_definition()));
    };
    const std::uint16_t moving = channel("/tf", false), fixed = channel("/tf_static", false);
    std::vector<RosTransform> mounts;
    for (const RigWriterSensor& sensor : sensors()) {
      if (sensor.name == kRosWorldFrame || sensor.name == kRosVehicleFrame)
        throw rig_error(sensor, "is named as a frame of the vehicle; choose another name");
      points_.push_back(channel(rig_topic(sensor.name, sensor.writing.driver), true));
      clouds_.emplace_back(sensor.writing.driver, sensor.writing.packets);
      mounts.push_back({{begin_s, sensor.mount * clouds_.back().sensor_from_points()},
                        kRosVehicleFrame,
                        sensor.name});
    }
    if (pictures_ != nullptr) add_cameras(begin_s, mounts);
    merged_.add(ros_time_ns(begin_s),
                mcap_message(fixed, ros_time_ns(begin_s), transforms_message(mounts)));
    for (const TimedPose& pose : vehicle()) {
      const RosTransform transform = {pose, kRosWorldFrame, kRosVehicleFrame};
      const std::uint64_t time_ns = ros_time_ns(pose.time_s);
      merged_.add(time_ns, mcap_message(moving, time_ns, transforms_message({&transform, 1})));
    }
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    const std::size_t k = sensor_of(index);
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.messages.push_back(
        mcap_message(points_[k], ros_time_ns(ros_stamp_s(scan) + later_s_),
                     clouds_[k].message(in_own_clock(index, scan), sensors()[k].name, later_s_)));
    return encoded;
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    const McapMessage& message = scan.messages.front();
    merged_.add(sensor_of(index), message.time_ns, message);
    if (pictures_ != nullptr && sensor_of(index) == 0) add_pictures(scan_of(index), scan.pose);
    write_merged(false);
  }
  void finish() override {
    write_merged(true);
    file_.finish();
    RigWriter::finish();
  }

 private:
  void write_merged(bool all) {
    merged_.take([this](const McapMessage& message) { file_.add_message(message); }, all);
  }

  struct CameraChannels {
    std::uint16_t images = 0, infos = 0;
    std::string frame;
  };

  /// Errors: usage (a name that is no part of a topic, or whose frame is that of a sensor).
  void add_cameras(double begin_s, std::vector<RosTransform>& mounts) {
    for (const MountedCamera& camera : pictures_->cameras()) {
      if (camera.name.empty() || camera.name.find_first_of(" \t\n/\\") != std::string::npos)
        throw Error(ErrorKind::usage, "camera '" + camera.name +
                                          "' of the rig: topics need a name without / and spaces");
      for (const RigWriterSensor& sensor : sensors())
        if (sensor.name == camera.name + "_optical")
          throw rig_error(sensor, "is named as the frame of a camera; choose another name");
      cameras_.push_back(
          {file_.add_channel(ros_channel("/" + camera.name + "/image_raw/compressed",
                                         kCompressedImageType, compressed_image_definition())),
           file_.add_channel(ros_channel("/" + camera.name + "/camera_info", kCameraInfoType,
                                         camera_info_definition())),
           camera.name + "_optical"});
    }
    for (std::size_t k = 0; k < cameras_.size(); ++k)
      mounts.push_back({{begin_s, pictures_->cameras()[k].vehicle_from_camera *
                                      RigidTransform{kCameraFromOptical, {}}},
                        kRosVehicleFrame,
                        cameras_[k].frame});
  }

  void add_pictures(std::size_t scan, const TimedPose& pose) {
    const double time_s = pose.time_s + later_s_;
    const std::uint64_t time_ns = ros_time_ns(time_s);
    const std::vector<std::string> pngs = pictures_->take(scan);
    for (std::size_t k = 0; k < pngs.size(); ++k) {
      const CameraChannels& camera = cameras_[k];
      const Lens& lens = pictures_->cameras()[k].lens;
      merged_.add(sensors().size(), time_ns,
                  mcap_message(camera.images, time_ns,
                               compressed_image_message(pngs[k], time_s, camera.frame)));
      merged_.add(
          sensors().size(), time_ns,
          mcap_message(camera.infos, time_ns, camera_info_message(lens, time_s, camera.frame)));
    }
  }

  McapFile file_;
  TimeMerge<McapMessage> merged_;
  RigPictures* pictures_;  ///< null: none
  std::vector<CameraChannels> cameras_;
  double later_s_;
  std::vector<std::uint16_t> points_;  ///< channels by sensor
  std::vector<DriverClouds> clouds_;   ///< by sensor
};

class RigPackets final : public RigWriter {
 public:
  RigPackets(const fs::path& folder, std::vector<RigWriterSensor> all, Trajectory poses)
      : RigWriter(folder, std::move(all), std::move(poses)),
        capture_(folder / "drive.pcap"),
        merged_(sensors().size()) {
    constexpr double kMaxOffset_s = 59, kHour_s = 3600;
    const double shift_s =
        kHour_s * std::ceil(std::max(0.0, -earliest_s(sensors(), vehicle())) / kHour_s);
    delay_poses(shift_s);
    const std::vector<UdpEndpoint> senders = rig_senders(sensors());
    for (std::size_t k = 0; k < sensors().size(); ++k) {
      const RigWriterSensor& sensor = sensors()[k];
      if (std::fabs(sensor.time_offset_s) > kMaxOffset_s)
        throw rig_error(sensor, "time_offset_s is " + exact_text(sensor.time_offset_s) +
                                    "; in a capture, clocks differ by less than a minute, since "
                                    "readers replace others by the clock of the capture");
      ScanWriterOptions writing = sensor.writing;
      writing.packets.sender = senders[k];
      writing.packets.time_offset_s = sensor.time_offset_s;
      writing.packets.shift_s = shift_s;
      create_folder(folder / sensor.name);
      writers_.push_back(
          make_packet_writer(folder / sensor.name, writing,
                             [this, k](std::uint64_t time_us, const UdpEndpoint& from,
                                       const UdpEndpoint& to, std::string payload) {
                               merged_.add(k, time_us, {time_us, from, to, std::move(payload)});
                             }));
    }
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    return writers_[sensor_of(index)]->encode(scan_of(index), scan);
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    writers_[sensor_of(index)]->append(scan_of(index), scan);
    write_merged(false);
  }
  void finish() override {
    for (const auto& writer : writers_) writer->finish();
    write_merged(true);
    capture_.finish();
    RigWriter::finish();
  }

 private:
  struct SentPacket {
    std::uint64_t time_us = 0;
    UdpEndpoint from, to;
    std::string payload;
  };

  void write_merged(bool all) {
    merged_.take(
        [this](const SentPacket& sent) {
          capture_.add(sent.time_us, sent.from, sent.to, sent.payload);
        },
        all);
  }

  CaptureWriter capture_;
  TimeMerge<SentPacket> merged_;
  std::vector<std::unique_ptr<ScanWriter>> writers_;
};

}  // namespace

std::vector<UdpEndpoint> rig_senders(const std::vector<RigWriterSensor>& sensors) {
  constexpr std::uint16_t kFirstPort = 2368;
  std::vector<UdpEndpoint> senders;
  std::set<std::pair<std::array<std::uint8_t, 4>, std::uint16_t>> used;
  const auto is_new = [&used](const UdpEndpoint& sender) {
    return used.emplace(sender.address, sender.port).second;
  };
  for (const RigWriterSensor& sensor : sensors)
    if (const auto& stated = sensor.writing.packets.sender; stated && !is_new(*stated))
      throw rig_error(sensor, "another sensor sends from its address and port, too");
  for (const RigWriterSensor& sensor : sensors) {
    UdpEndpoint sender = sensor.writing.packets.sender.value_or(factory_sender(kFirstPort));
    if (!sensor.writing.packets.sender)
      while (!is_new(sender)) ++sender.port;
    senders.push_back(sender);
  }
  return senders;
}

double rig_ros_delay_s(const std::vector<RigWriterSensor>& sensors, const Trajectory& vehicle) {
  const double first_s = earliest_s(sensors, vehicle);
  return sensors.front().writing.drive.begin_s() >= 0 && first_s < 0 ? std::ceil(-first_s) : 0;
}

std::string rig_topic(const std::string& sensor, CloudDriver driver) {
  const std::string_view topic = topic_of(driver).topic;
  return "/" + sensor + std::string(topic.substr(topic.rfind('/')));
}

void require_rig_format(ScanFormat format) {
  if (format == ScanFormat::nuscenes || format == ScanFormat::argoverse2)
    throw Error(ErrorKind::usage, std::string(word_of(format, kScanFormats)) +
                                      " is written and read with one LiDAR, " +
                                      (format == ScanFormat::nuscenes ? "LIDAR_TOP" : "up_lidar") +
                                      "; use another `format` for a rig, such as mcap");
}

void RigPictures::add(std::size_t scan, std::vector<std::string> pngs) {
  const std::lock_guard lock(mutex_);
  drawn_[scan] = std::move(pngs);
}

std::vector<std::string> RigPictures::take(std::size_t scan) {
  const std::lock_guard lock(mutex_);
  auto found = drawn_.extract(scan);
  return found.empty() ? std::vector<std::string>() : std::move(found.mapped());
}

std::unique_ptr<ScanWriter> make_rig_writer(const fs::path& folder, ScanFormat format,
                                            std::vector<RigWriterSensor> sensors,
                                            Trajectory vehicle, RigPictures* pictures) {
  require_rig_format(format);
  if (format == ScanFormat::mcap)
    return std::make_unique<RigMessages>(folder, std::move(sensors), std::move(vehicle), pictures);
  if (format == ScanFormat::pcap)
    return std::make_unique<RigPackets>(folder, std::move(sensors), std::move(vehicle));
  return std::make_unique<RigFolders>(folder, format, std::move(sensors), std::move(vehicle));
}

}  // namespace adasplats
