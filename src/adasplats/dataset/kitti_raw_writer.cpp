// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_raw_writer.h"

#include <algorithm>
#include <string>
#include <vector>

#include "adasplats/dataset/kitti_order.h"
#include "adasplats/dataset/oxts_records.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/tree_names.h"
#include "adasplats/dataset/writer_with_poses.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

constexpr const char* kCalibrationTime = "calib_time: 01-Jan-1970 00:00:00\n";

// Position of the GPS/IMU unit of KITTI's car (calib_imu_to_velo.txt of 2011_09_26, rounded); it
// exposes loaders that ignore it.
constexpr RigidTransform kVelodyneFromImu = {{}, {-0.81, 0.32, -0.80}};
constexpr const char* kImuToVelodyne = "R: 1 0 0 0 1 0 0 0 1\nT: -0.81 0.32 -0.8\n";
// Camera axes (x right, y down, z forward) against LiDAR axes (x forward, y left, z up).
constexpr const char* kVelodyneToCamera = "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\n";

/// Rectified images of KITTI are 1242 x 375; none are written here.
std::string camera_calibration() {
  const std::string intrinsic = "721.5 0 609.5 0 721.5 172.9 0 0 1\n";
  const std::string unit = "1 0 0 0 1 0 0 0 1\n";
  std::string text = std::string(kCalibrationTime) + "corner_dist: 0.0995\n";
  for (const std::string camera : {"00", "01", "02", "03"}) {
    text += "S_" + camera + ": 1242 375\nK_" + camera + ": " + intrinsic;
    text += "D_" + camera + ": 0 0 0 0 0\nR_" + camera + ": " + unit;
    text += "T_" + camera + ": 0 0 0\nS_rect_" + camera + ": 1242 375\n";
    text += "R_rect_" + camera + ": " + unit;
    text += "P_rect_" + camera + ": 721.5 0 609.5 0 0 721.5 172.9 0 0 0 1 0\n";
  }
  return text;
}

std::string ten_digits(std::size_t index) { return padded_number(index, 10); }

class KittiRawWriter final : public WriterWithPoses {
 public:
  KittiRawWriter(const std::filesystem::path& folder, const ScanWriterOptions& options)
      : WriterWithPoses(folder), order_(options.order) {
    date_ = date_and_time(options.drive.begin_s(), folder.string()).substr(0, 10);
    std::ranges::replace(date_, '-', '_');
    drive_ = date_ + "/" + date_ + "_drive_0001_sync/";
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    std::vector<std::uint32_t> order;
    if (order_ == PointOrder::kitti) order = kitti_order(scan);
    encoded.files.push_back({main_file(index), points_with_intensity(scan, order)});
    return encoded;
  }
  std::string main_file(std::size_t index) const override {
    return drive_ + "velodyne_points/data/" + ten_digits(index) + ".bin";
  }
  void finish() override {
    const std::filesystem::path day = folder() / date_, drive = folder() / drive_;
    const Trajectory imu = mounted(trajectory(), kVelodyneFromImu);
    const OxtsRecords records(imu);
    std::string times;
    create_folder(drive / "oxts" / "data");
    create_folder(drive / "velodyne_points" / "data");
    for (std::size_t i = 0; i < imu.size(); ++i) {
      const std::string name = ten_digits(i);
      write_file(drive / "oxts" / "data" / (name + ".txt"), records.line(i));
      times += date_and_time(imu[i].time_s, main_file(i)) + "\n";
    }
    write_file(drive / "oxts" / "dataformat.txt", oxts_data_format());
    write_file(drive / "oxts" / "timestamps.txt", times);
    write_file(drive / "velodyne_points" / "timestamps.txt", times);
    write_file(day / "calib_imu_to_velo.txt", std::string(kCalibrationTime) + kImuToVelodyne);
    write_file(day / "calib_velo_to_cam.txt",
               std::string(kCalibrationTime) + kVelodyneToCamera + "delta_f: 0 0\ndelta_c: 0 0\n");
    write_file(day / "calib_cam_to_cam.txt", camera_calibration());
    WriterWithPoses::finish();
  }

 private:
  PointOrder order_;
  std::string date_, drive_;
};

}  // namespace

std::unique_ptr<ScanWriter> make_kitti_raw_writer(const std::filesystem::path& folder,
                                                  const ScanWriterOptions& options) {
  return std::make_unique<KittiRawWriter>(folder, options);
}

}  // namespace adasplats
