// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats {

/// A sensor of a rig, and how to write its scans. Times of scans and of `writing` are those of the
/// vehicle's poses; files have the times of the sensor.
struct RigWriterSensor {
  std::string name;
  RigidTransform mount;      ///< vehicle_from_sensor
  double time_offset_s = 0;  ///< added to the times of the sensor to get those of the poses
  ScanWriterOptions writing;
};

/// The cameras of a rig, with the pictures that were drawn ahead of its scans.
class RigPictures {
 public:
  explicit RigPictures(std::vector<MountedCamera> cameras) : cameras_(std::move(cameras)) {}

  const std::vector<MountedCamera>& cameras() const { return cameras_; }
  /// PNG files with scan `scan` of the first sensor, one per camera. Thread-safe.
  void add(std::size_t scan, std::vector<std::string> pngs);
  /// Removes and returns them; none if there are none. Thread-safe.
  std::vector<std::string> take(std::size_t scan);

 private:
  std::vector<MountedCamera> cameras_;
  std::mutex mutex_;
  std::map<std::size_t, std::vector<std::string>> drawn_;
};

/// The number of scan `scan` of sensor `sensor` in a rig of `sensors`.
constexpr std::size_t rig_scan_number(std::size_t scan, std::size_t sensor, std::size_t sensors) {
  return scan * sensors + sensor;
}

/// Shift of all times in ROS messages, which cannot be negative, as ros_delay_s().
double rig_ros_delay_s(const std::vector<RigWriterSensor>& sensors, const Trajectory& vehicle);

/// Where the sensors send packets from: as stated, else from the port 2368 upwards. Errors: usage
/// (two send from one address and port).
std::vector<UdpEndpoint> rig_senders(const std::vector<RigWriterSensor>& sensors);

/// The topic of the clouds of a sensor: its name, and the last part of topic_of().
std::string rig_topic(const std::string& sensor, CloudDriver driver);

/// Throws usage for nuscenes and argoverse2, whose writers and readers have one LiDAR.
void require_rig_format(ScanFormat format);

/// A writer of scans with rig_scan_number(). All formats write poses.csv, those of the vehicle.
/// mcap: FOLDER/scans.mcap with a topic per sensor (rig_topic()), /tf (base_link in map) and
/// /tf_static (NAME in base_link), all rig_ros_delay_s() later; `pictures` (null: none) with the
/// time of the pose of a scan as /CAMERA/image_raw/compressed and /CAMERA/camera_info in the frame
/// CAMERA_optical. pcap: FOLDER/drive.pcap, and in NAME/ the files of make_packet_writer(). Both in
/// the order of the vehicle's clock, if scans of different sensors are appended in turns. Other
/// formats: the files of make_scan_writer() in NAME/, and NAME.times, the times of the scans
/// (read_scan_times()). Errors: usage (nuscenes, which the writer limits to one LiDAR; names of
/// frames and cameras in mcap; pcap: an offset of a minute, two sensors that send from one address
/// and port), those of make_scan_writer().
std::unique_ptr<ScanWriter> make_rig_writer(const std::filesystem::path& folder, ScanFormat format,
                                            std::vector<RigWriterSensor> sensors,
                                            Trajectory vehicle, RigPictures* pictures = nullptr);

/// Sorts the items of several sources by time. The times of each source ascend.
template <class Item>
class TimeMerge {
 public:
  explicit TimeMerge(std::size_t sources) : latest_(sources, 0) {}

  void add(std::size_t source, std::uint64_t time, Item item) {
    latest_[source] = std::max(latest_[source], time);
    items_.emplace(time, std::move(item));
  }
  /// An item of no source; its time is not before those that were passed on.
  void add(std::uint64_t time, Item item) { items_.emplace(time, std::move(item)); }
  /// Passes on the items that no later one can precede; with `all` the rest.
  template <class Take>
  void take(Take&& take_item, bool all = false) {
    const std::uint64_t ready = all ? ~std::uint64_t{0} : *std::ranges::min_element(latest_);
    while (!items_.empty() && items_.begin()->first <= ready)
      take_item(items_.extract(items_.begin()).mapped());
  }

 private:
  std::vector<std::uint64_t> latest_;
  std::multimap<std::uint64_t, Item> items_;
};

}  // namespace adasplats
