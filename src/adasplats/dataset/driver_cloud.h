// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Frame and topic of the clouds of one sensor, as the driver's configuration names them.
struct DriverTopic {
  std::string_view topic, frame;
};
DriverTopic topic_of(CloudDriver driver);

/// The pose of the driver's frame in the sensor's: velodyne as the sensor; ouster, os_lidar, looks
/// back at the height of the beams; hesai and nebula have x right and y forward.
RigidTransform sensor_from_frame(CloudDriver driver, const LidarModel& sensor);

/// Throws usage, with the reason, if a sensor has no clouds of this driver: beams without rings and
/// columns, motion compensation, more returns than a cloud has, revolutions beyond 32 bits of ns.
void require_driver(CloudDriver driver, const PacketOptions& options);

/// Encodes scans as the PointCloud2 of a driver. The table in docs/exports.md describes them and
/// names the sources. `adasplats`: point_cloud2_message(), for which `options` are not used.
class DriverClouds {
 public:
  /// `options.sensor` is used only here. Errors: those of require_driver().
  DriverClouds(CloudDriver driver, const PacketOptions& options);

  /// The message; times are `later_s` later. Thread-safe. Throws std::logic_error for a scan
  /// without rings, columns, times or ranges. Errors: those of cloud_message().
  std::string message(const ScanView& scan, std::string_view frame, double later_s) const;
  /// The pose of the points' frame in that of the sensor.
  const RigidTransform& sensor_from_points() const { return sensor_from_points_; }

 private:
  struct Point;
  std::size_t place_of(std::size_t ring, std::size_t column, std::size_t number) const;
  void write_grid(const ScanView& scan, double stamp_s, char* to) const;
  Point point_of(const ScanView& scan, std::size_t i, double stamp_s) const;

  CloudDriver driver_;
  RigidTransform sensor_from_points_;
  std::size_t returns_ = 1;
  double return_type_ = 0;  ///< of the first return, in Nebula's numbers
  double full_intensity_ = 1;
  ImageSize size_;
  std::size_t rows_ = 0;                   ///< columns that fire
  std::vector<std::uint32_t> row_of_;      ///< by column; kNoRow: does not fire
  std::vector<float> times_s_;             ///< by ring * columns + column
  std::vector<std::size_t> column_shift_;  ///< by ring, of images by azimuth
  std::vector<double> from_axis_m_;        ///< by ring, where ranges begin
};

}  // namespace adasplats
