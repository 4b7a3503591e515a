// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/dataset/kitti_order.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// What names of files need to know of a drive before its scans are there.
struct DriveSpan {
  double begin_s = 0;     ///< of the first scan, since 1970
  double apart_s = 0;     ///< from the first scan to the second; 0: there is none
  std::size_t scans = 0;  ///< of the whole drive
  double turn_s = 0;      ///< how long a revolution lasts in which the sensor moves; 0: it stands

  DriveSpan() = default;
  /// Of `count` scans; time_of(i) is when scan i is. Two are asked for at most.
  template <class TimeOf>
  DriveSpan(std::size_t count, TimeOf&& time_of)
      : begin_s(count == 0 ? 0 : time_of(0)),
        apart_s(count < 2 ? 0 : time_of(1) - begin_s),
        scans(count) {}
};

/// How much later the times of a drive are in messages of ROS, which know none before 0, in whole
/// seconds: 0 unless the first scan, but not the beginning of its revolution, is at 0 or later.
double ros_delay_s(const DriveSpan& drive);

/// The objects of a world in scan number `index` at `time_s`. Several threads may call it at once.
using BoxesOfScan = std::function<std::vector<ObjectBox>(std::size_t index, double time_s)>;

/// What packets need to know beside the scans.
struct PacketOptions {
  const LidarModel* sensor = nullptr;  ///< that measured them; outlives the writer
  double begin_after_s =
      0;            ///< the revolution begins so long after a scan's time; negative: before
  int returns = 1;  ///< that a firing can have
  bool has_angular_noise = true;  ///< the sensor's is simulated
  bool is_raw = true;             ///< the motion is in the points, as measured
  double full_intensity = 1.0;    ///< what becomes 255, the largest
};

struct ScanWriterOptions {
  ImageSize image_size;                  ///< of range images (image_size_of)
  double full_intensity = 1.0;           ///< LAS: what becomes its largest intensity
  const LabelScheme* labels = nullptr;   ///< names and colours of classes; outlives the writer
  PointOrder order = PointOrder::kitti;  ///< of points in KITTI's files
  DriveSpan drive;                       ///< trees that name files by it, and ros_delay_s()
  BoxesOfScan boxes;                     ///< trees that list objects; none: there is no world
  PacketOptions packets;                 ///< pcap
};

/// Makes scans of one drive files of a folder. What a scan becomes can be worked out and written by
/// several threads at once (encode(), write_encoded()); what all scans have in common is made in
/// their order (append(), finish()). ParallelScanWriter does that.
class ScanWriter {
 public:
  explicit ScanWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
  virtual ~ScanWriter() = default;
  ScanWriter(const ScanWriter&) = delete;
  ScanWriter& operator=(const ScanWriter&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Scan number `index` as bytes; its main_file() is the last of its files. Several threads may
  /// call it at once. Errors: those of the formats.
  virtual EncodedScan encode(std::size_t index, const ScanView& scan) const = 0;
  /// Takes scan number `index`, whose own files are written: what it adds to files of all scans.
  /// One call at a time, in the order of the numbers. Errors: io.
  virtual void append(std::size_t index, const EncodedScan& scan) = 0;
  /// The name of the file that every scan has, relative to folder(); empty where scans have no
  /// files of their own, so that a run that was interrupted begins anew.
  virtual std::string main_file(std::size_t index) const = 0;
  /// As append(), for a scan whose files an interrupted run wrote. Errors: io (they are missing).
  virtual void keep(std::size_t index, const TimedPose& pose) = 0;
  /// Writes what all scans have in common. To be called once, last. Errors: cannot_create, io.
  virtual void finish() = 0;

  /// Encodes scan number `index`, writes its files (atomic) and appends it.
  void write(std::size_t index, const ScanView& scan);

 private:
  std::filesystem::path folder_;
};

/// A writer into `folder`, which exists. semantickitti: FOLDER/sequences/00 as SemanticKittiWriter
/// and FOLDER/poses/00.txt, points in `options.order`; range_image: files of write_range_image();
/// mcap: FOLDER/scans.mcap as McapWriter, and poses.csv, both ros_delay_s() later; kitti_raw,
/// pandaset, nuscenes: as make_kitti_raw_writer(), make_pandaset_writer() and
/// make_nuscenes_writer(); pcap: make_packet_writer(); else NNNNNN.EXT of scan_files.h. All but
/// semantickitti have poses.csv beside them. Errors: cannot_create, io; mcap, kitti_raw: data
/// (times that they cannot express).
std::unique_ptr<ScanWriter> make_scan_writer(const std::filesystem::path& folder, ScanFormat format,
                                             const ScanWriterOptions& options = {});

/// SemanticKITTI's layout with a sequence of that name: FOLDER/sequences/NAME and, with the same
/// text as its poses.txt, FOLDER/poses/NAME.txt, where KITTI's odometry data set has it.
std::unique_ptr<ScanWriter> make_sequence_writer(const std::filesystem::path& folder,
                                                 const std::string& name,
                                                 PointOrder order = PointOrder::kitti);

}  // namespace adasplats
