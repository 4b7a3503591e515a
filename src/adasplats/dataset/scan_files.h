// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Output format of scans: the tree of a data set, point files, pictures, or messages.
enum class ScanFormat : std::uint8_t {
  semantickitti,
  ply,
  npy,
  npz,
  pcd,
  las,
  laz,
  range_image,
  mcap,
  kitti_raw,
  pandaset,
  nuscenes,
  argoverse2,
  pcap
};
inline constexpr std::pair<std::string_view, ScanFormat> kScanFormats[] = {
    {"semantickitti", ScanFormat::semantickitti},
    {"ply", ScanFormat::ply},
    {"npy", ScanFormat::npy},
    {"npz", ScanFormat::npz},
    {"pcd", ScanFormat::pcd},
    {"las", ScanFormat::las},
    {"laz", ScanFormat::laz},
    {"range-image", ScanFormat::range_image},
    {"mcap", ScanFormat::mcap},
    {"kitti-raw", ScanFormat::kitti_raw},
    {"pandaset", ScanFormat::pandaset},
    {"nuscenes", ScanFormat::nuscenes},
    {"argoverse2", ScanFormat::argoverse2},
    {"pcap", ScanFormat::pcap}};

/// Layout of the point clouds in MCAP: ours, with all attributes, or that of the driver of a sensor
/// (driver_cloud.h).
enum class CloudDriver : std::uint8_t { adasplats, velodyne, ouster, hesai, nebula };
inline constexpr std::pair<std::string_view, CloudDriver> kCloudDrivers[] = {
    {"adasplats", CloudDriver::adasplats},
    {"velodyne", CloudDriver::velodyne},
    {"ouster", CloudDriver::ouster},
    {"hesai", CloudDriver::hesai},
    {"nebula", CloudDriver::nebula}};

/// Whether the format is the tree of a data set, with points in the order of that data set.
constexpr bool is_tree(ScanFormat format) {
  return format == ScanFormat::semantickitti ||
         (format >= ScanFormat::kitti_raw && format != ScanFormat::pcap);
}

/// Estimated bytes of scans, without headers and common data.
struct ScanBytes {
  double min_a_return;  ///< positions and mandatory attributes
  double max_a_return;  ///< with all attributes
  double min_a_ray;     ///< for every ray, with or without return
  double max_a_ray;     ///< likewise, before compression
};
ScanBytes scan_bytes(ScanFormat format);

/// Whether the format stores the velocities of points.
constexpr bool has_velocities(ScanFormat format) {
  return (format >= ScanFormat::npz && format <= ScanFormat::laz) || format == ScanFormat::ply ||
         format == ScanFormat::mcap;
}

/// Attributes that the format stores or that its point order needs.
ScanFields fields_of(ScanFormat format);

// One scan as a file, in the sensor frame. All are atomic.

/// PLY with the columns of scan_columns().
void write_scan_ply(const std::filesystem::path& path, const ScanView& scan);

/// .npy: PATH (float32, N x 4: x y z intensity) and PATH with "_label" before the extension
/// (uint32, N: instance << 16 | class). Zeros for missing attributes.
void write_scan_npy(const std::filesystem::path& path, const ScanView& scan);

/// .npz with, if the scan has them, points (float32, N x 3), intensities, labels (class
/// ids), instances, rings, columns, times (times_from_pose()), ranges, return_indices (N each),
/// world_from_sensor (float64, 4 x 4) and time (float64, 1).
void write_scan_npz(const std::filesystem::path& path, const ScanView& scan);

/// PCD, binary, with the columns of scan_columns(); VIEWPOINT is world_from_sensor.
void write_scan_pcd(const std::filesystem::path& path, const ScanView& scan);

/// LAS 1.4 (LAZ if the path ends in .laz), point format 6, in millimetres. Intensity:
/// 0..`full_intensity` becomes 0..65535. Classification is the low byte of the class. GPS time is
/// the time of the point, or the scan's time if the sensor was at rest (see times_from_pose()).
/// Extra bytes, if the scan has them: intensity_value, label, instance, ring, column, range.
void write_scan_las(const std::filesystem::path& path, const ScanView& scan,
                    double full_intensity = 1.0);

/// The same as bytes: the files of a scan in `format` (ply, npy, npz, pcd, las or laz, otherwise
/// std::logic_error), named `stem` with their extensions. Errors: those of the formats.
std::vector<EncodedFile> encode_scan_files(ScanFormat format, const std::string& stem,
                                           const ScanView& scan, double full_intensity = 1.0);

}  // namespace adasplats
