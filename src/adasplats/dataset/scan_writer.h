// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/dataset/kitti_order.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// Properties of a drive that file names need before the scans exist.
struct DriveSpan {
  std::vector<double> times_s;  ///< of the scans, since 1970
  double turn_s = 0;            ///< duration of a revolution during motion; 0: sensor at rest

  DriveSpan() = default;
  /// For `count` scans; time_of(i) is the time of scan i.
  template <class TimeOf>
  DriveSpan(std::size_t count, TimeOf&& time_of) {
    times_s.reserve(count);
    for (std::size_t i = 0; i < count; ++i) times_s.push_back(time_of(i));
  }

  double begin_s() const { return times_s.empty() ? 0 : times_s.front(); }
  /// From the first scan to the second; 0: only one scan.
  double apart_s() const { return times_s.size() < 2 ? 0 : times_s[1] - times_s[0]; }
};

/// Shift of the times of a drive in ROS messages, which cannot be negative, in whole seconds: 0
/// unless the first scan is at 0 or later but its revolution begins before 0.
double ros_delay_s(const DriveSpan& drive);

/// The objects of a world in scan number `index` at `time_s`. Must be thread-safe.
using BoxesOfScan = std::function<std::vector<ObjectBox>(std::size_t index, double time_s)>;

/// World::velocities() of scan number `index`. Must be thread-safe.
using VelocitiesOfScan = std::function<std::vector<Vec3f>(std::size_t index, const ScanView& scan)>;

/// Information for packets and clouds of drivers in addition to the scans.
struct PacketOptions {
  const LidarModel* sensor = nullptr;  ///< that measured the scans; must outlive the writer
  double begin_after_s =
      0;            ///< begin of the revolution relative to the scan's time; negative: before
  int returns = 1;  ///< maximum per firing
  ReturnMode mode = ReturnMode::strongest;  ///< clouds of drivers
  bool has_angular_noise = true;            ///< angular noise is simulated
  bool is_raw = true;                       ///< points as measured, without motion compensation
  double full_intensity = 1.0;              ///< intensity that becomes 255, the maximum
  /// Added to the times of the sensor to get those of the capture, less than a minute.
  double time_offset_s = 0;
  /// Added to all times; not set: an hour if the first scan begins before 1970.
  std::optional<double> shift_s;
  std::optional<UdpEndpoint> sender;  ///< not set: the factory settings of sensors
};

struct ScanWriterOptions {
  ImageSize image_size;                  ///< of range images (image_size_of)
  double full_intensity = 1.0;           ///< LAS, Argoverse 2: intensity that becomes the maximum
  const LabelScheme* labels = nullptr;   ///< names and colours of classes; must outlive the writer
  PointOrder order = PointOrder::kitti;  ///< of points in KITTI's files
  DriveSpan drive;                       ///< for file names of data sets, and ros_delay_s()
  BoxesOfScan boxes;                     ///< for data sets with objects; none without a world
  VelocitiesOfScan velocities;           ///< has_velocities(); none: not wanted
  CloudDriver driver = CloudDriver::adasplats;  ///< mcap
  RigidTransform mount;                         ///< mcap: vehicle_from_sensor
  PacketOptions packets;                        ///< pcap, and mcap of a driver
};

/// Writes the scans of one drive to files in a folder. Several threads can encode and write scans
/// concurrently (encode(), write_encoded()); data common to all scans is appended in order
/// (append(), finish()). ParallelScanWriter does this.
class ScanWriter {
 public:
  explicit ScanWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
  virtual ~ScanWriter() = default;
  ScanWriter(const ScanWriter&) = delete;
  ScanWriter& operator=(const ScanWriter&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Encodes scan number `index`; its main_file() is the last of its files. Thread-safe. Errors:
  /// those of the formats.
  virtual EncodedScan encode(std::size_t index, const ScanView& scan) const = 0;
  /// Adds the data of scan number `index`, after its own files are written, to the files of all
  /// scans. Not thread-safe; in the order of the numbers. Errors: io.
  virtual void append(std::size_t index, const EncodedScan& scan) = 0;
  /// Name of the file that every scan has, relative to folder(); empty if scans have no files of
  /// their own, so an interrupted run starts from the beginning.
  virtual std::string main_file(std::size_t index) const = 0;
  /// As append(), for a scan with files from an interrupted run. Errors: io (files are missing).
  virtual void keep(std::size_t index, const TimedPose& pose) = 0;
  /// Writes the data common to all scans. Call once, last. Errors: cannot_create, io.
  virtual void finish() = 0;

  /// Encodes scan number `index`, writes its files (atomic) and appends it.
  void write(std::size_t index, const ScanView& scan);

 private:
  std::filesystem::path folder_;
};

/// A writer into `folder`, which must exist. semantickitti: FOLDER/sequences/00 as
/// SemanticKittiWriter and FOLDER/poses/00.txt, points in `options.order`; range_image: files of
/// write_range_image(); mcap: FOLDER/scans.mcap as McapWriter, and poses.csv, both ros_delay_s()
/// later; kitti_raw, pandaset, nuscenes, argoverse2: as make_kitti_raw_writer(),
/// make_pandaset_writer(), make_nuscenes_writer() and make_av2_writer(); pcap:
/// make_packet_writer(); else NNNNNN.EXT of scan_files.h. All but semantickitti also write
/// poses.csv. Errors: cannot_create, io; mcap, kitti_raw, argoverse2: data (times that they cannot
/// represent).
std::unique_ptr<ScanWriter> make_scan_writer(const std::filesystem::path& folder, ScanFormat format,
                                             const ScanWriterOptions& options = {});

/// SemanticKITTI's layout with a sequence of that name: FOLDER/sequences/NAME, and a copy of its
/// poses.txt as FOLDER/poses/NAME.txt, as in KITTI's odometry data set.
std::unique_ptr<ScanWriter> make_sequence_writer(const std::filesystem::path& folder,
                                                 const std::string& name,
                                                 PointOrder order = PointOrder::kitti);

}  // namespace adasplats
