// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrays/npz.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/pcd/pcd_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {

namespace {

/// Row-major.
std::array<double, 16> matrix_of(const RigidTransform& transform) {
  std::array<double, 16> values = {};
  std::size_t place = 0;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) values[place++] = transform.rotation.rows[r][c];
    values[place++] = transform.translation[r];
  }
  values[15] = 1;
  return values;
}

PcdViewpoint viewpoint_of(const RigidTransform& pose) {
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  const Vec3d t = pose.translation;
  return {t.x, t.y, t.z, q.w, q.x, q.y, q.z};
}

/// The array names of scan_columns().
std::string array_name(std::string_view column) {
  if (column == "intensity") return "intensities";
  if (column == "return_index") return "return_indices";
  return std::string(column) + "s";
}

constexpr std::uint16_t kMaxLasClass = 255;

/// Columns with their own LAS fields.
struct LasFields {
  std::vector<std::uint16_t> intensities;
  std::vector<std::uint8_t> classes, return_numbers, returns;
  std::vector<double> times;

  LasFields(const ScanView& scan, double full_intensity) : returns(returns_of_firings(scan)) {
    intensities.reserve(scan.intensities.size());
    for (const float value : scan.intensities) {
      const double share = std::isnan(value) ? 0.0 : static_cast<double>(value) / full_intensity;
      intensities.push_back(
          static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0))));
    }
    // A class that does not fit the field is written as "never classified"; `label` holds it.
    for (const std::uint16_t id : scan.classes)
      classes.push_back(id > kMaxLasClass ? std::uint8_t{0} : static_cast<std::uint8_t>(id));
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const int number = scan.return_indices.empty() ? 1 : scan.return_indices[i] + 1;
      return_numbers.push_back(static_cast<std::uint8_t>(number));
    }
    times.assign(scan.moved() ? scan.times_s.size() : scan.size(), scan.time_s);
    for (std::size_t i = 0; scan.moved() && i < times.size(); ++i)
      times[i] = scan.begin_s() + static_cast<double>(scan.times_s[i]);
  }

  std::vector<ColumnView> columns() const {
    std::vector<ColumnView> columns = {{"return_number", ColumnType::u8, return_numbers.data(), 1},
                                       {"number_of_returns", ColumnType::u8, returns.data(), 1}};
    if (!intensities.empty())
      columns.push_back({"intensity", ColumnType::u16, intensities.data(), 2});
    if (!classes.empty()) columns.push_back({"classification", ColumnType::u8, classes.data(), 1});
    if (!times.empty()) columns.push_back({"gps_time", ColumnType::f64, times.data(), 8});
    return columns;
  }
};

/// Most formats have a fixed number of bytes per point.
constexpr std::size_t kExpectedPointBytes = 48;

std::string ply_bytes(const ScanView& scan) {
  ByteBuffer file(scan.size() * kExpectedPointBytes);
  put_ply(file, scan.size(), scan_columns(scan, times_from_pose(scan)));
  return file.take();
}

std::string pcd_bytes(const ScanView& scan) {
  ByteBuffer file(scan.size() * kExpectedPointBytes);
  put_pcd(file, scan.size(), scan_columns(scan, times_from_pose(scan)),
          viewpoint_of(scan.world_from_sensor));
  return file.take();
}

std::string npz_bytes(const std::filesystem::path& path, const ScanView& scan) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  std::vector<NamedArray> arrays = {
      {"points", {ColumnType::f32, {scan.size(), 3}, scan.positions.data()}}};
  const std::vector<float> times = times_from_pose(scan);
  const std::vector<ColumnView> columns = scan_columns(scan, times);
  constexpr std::size_t kPosition = 3;  // x, y and z are "points"
  for (std::size_t k = kPosition; k < columns.size(); ++k)
    if (columns[k].stride_bytes == type_bytes(columns[k].type))
      arrays.push_back(
          {array_name(columns[k].name), {columns[k].type, {scan.size()}, columns[k].data}});
  if (!scan.velocities.empty())
    arrays.push_back({"velocities", {ColumnType::f32, {scan.size(), 3}, scan.velocities.data()}});
  const std::array<double, 16> pose = matrix_of(scan.world_from_sensor);
  arrays.push_back({"world_from_sensor", {ColumnType::f64, {4, 4}, pose.data()}});
  arrays.push_back({"time", {ColumnType::f64, {1}, &scan.time_s}});
  ByteBuffer file(scan.size() * kExpectedPointBytes);
  put_npz(file, path, arrays);
  return file.take();
}

std::string las_bytes(const std::filesystem::path& path, const ScanView& scan,
                      double full_intensity) {
  const LasFields fields(scan, full_intensity);
  std::vector<ColumnView> columns = fields.columns();
  for (ColumnView column : scan_columns(scan, {})) {
    if (column.name == "time" || column.name == "return_index") continue;
    if (column.name == "intensity") column.name = "intensity_value";
    columns.push_back(column);
  }
  LasWriteOptions options;
  options.is_packed = is_laz_name(path);
  ByteBuffer file(scan.size() * (options.is_packed ? 16 : kExpectedPointBytes + 16));
  put_las(file, path, scan.size(), columns, options);
  return file.take();
}

std::string npy_bytes(const NpyArray& array) {
  ByteBuffer file(array.size_bytes() + 128);
  put_npy(file, array);
  return file.take();
}

std::string npy_points(const ScanView& scan) {
  const std::string points = points_with_intensity(scan);
  return npy_bytes({ColumnType::f32, {scan.size(), 4}, points.data()});
}

std::string npy_labels(const ScanView& scan) {
  const std::vector<std::uint32_t> labels = packed_labels(scan);
  return npy_bytes({ColumnType::u32, {scan.size()}, labels.data()});
}

}  // namespace

ScanFields fields_of(ScanFormat format) {
  ScanFields fields;
  if (format == ScanFormat::semantickitti || format == ScanFormat::kitti_raw)
    fields.ranges = fields.columns = fields.times = false;
  if (format == ScanFormat::pandaset) fields.ranges = false;
  if (format == ScanFormat::argoverse2) fields.ranges = fields.classes = fields.instances = false;
  if (format == ScanFormat::pcap) fields.classes = fields.instances = fields.times = false;
  if (format == ScanFormat::nuscenes) fields.ranges = fields.times = false;
  return fields;
}

ScanBytes scan_bytes(ScanFormat format) {
  // Position, ring, column, time and range; then intensity, label, instance and return index.
  constexpr double kLeast = 12 + 2 + 4 + 4 + 4, kMost = kLeast + 4 + 2 + 2 + 1;
  switch (format) {
    case ScanFormat::semantickitti: return {16, 20, 0, 0};
    case ScanFormat::kitti_raw: return {16, 16, 0, 0};
    // At least half of the uncompressed size: the last bits of coordinates are noise.
    case ScanFormat::pandaset: return {20, 56, 0, 0};
    case ScanFormat::nuscenes: return {20, 21, 0, 0};
    case ScanFormat::argoverse2: return {18, 18, 0, 0};
    case ScanFormat::npy: return {20, 20, 0, 0};
    case ScanFormat::pcap: return {0, 0, 3, 13};  // channels of Velodyne, of Ouster, and headers
    case ScanFormat::ply:
    case ScanFormat::pcd:
    case ScanFormat::npz: return {kLeast, kMost, 0, 0};
    case ScanFormat::las:
      return {30 + 10, 30 + 18, 0, 0};  // point format 6 and extra bytes
    // Scans of an HDL-64E with all attributes have 9 bytes per return.
    case ScanFormat::laz: return {6, 30 + 18, 0, 0};
    case ScanFormat::range_image: return {0, 0, 4, 4 + 2 + 4 + 3};
    case ScanFormat::mcap: return {20, 28, 0, 0};  // fields are aligned, without range and column
  }
  throw std::logic_error("scan_bytes: unknown format");
}

void write_scan_ply(const std::filesystem::path& path, const ScanView& scan) {
  write_file(path, ply_bytes(scan));
}

void write_scan_npy(const std::filesystem::path& path, const ScanView& scan) {
  write_file(path, npy_points(scan));
  std::filesystem::path labels_path = path;
  labels_path.replace_filename(path.stem().string() + "_label" + path.extension().string());
  write_file(labels_path, npy_labels(scan));
}

void write_scan_npz(const std::filesystem::path& path, const ScanView& scan) {
  write_file(path, npz_bytes(path, scan));
}

void write_scan_pcd(const std::filesystem::path& path, const ScanView& scan) {
  write_file(path, pcd_bytes(scan));
}

void write_scan_las(const std::filesystem::path& path, const ScanView& scan,
                    double full_intensity) {
  write_file(path, las_bytes(path, scan, full_intensity));
}

std::vector<EncodedFile> encode_scan_files(ScanFormat format, const std::string& stem,
                                           const ScanView& scan, double full_intensity) {
  std::vector<EncodedFile> files;
  switch (format) {
    case ScanFormat::ply: files.push_back({stem + ".ply", ply_bytes(scan)}); break;
    case ScanFormat::pcd: files.push_back({stem + ".pcd", pcd_bytes(scan)}); break;
    case ScanFormat::npz: files.push_back({stem + ".npz", npz_bytes(stem + ".npz", scan)}); break;
    case ScanFormat::las:
      files.push_back({stem + ".las", las_bytes(stem + ".las", scan, full_intensity)});
      break;
    case ScanFormat::laz:
      files.push_back({stem + ".laz", las_bytes(stem + ".laz", scan, full_intensity)});
      break;
    case ScanFormat::npy:
      files.push_back({stem + ".npy", npy_points(scan)});
      files.push_back({stem + "_label.npy", npy_labels(scan)});
      break;
    case ScanFormat::semantickitti:
    case ScanFormat::range_image:
    case ScanFormat::mcap:
    case ScanFormat::kitti_raw:
    case ScanFormat::pandaset:
    case ScanFormat::nuscenes:
    case ScanFormat::argoverse2:
    case ScanFormat::pcap: throw std::logic_error("encode_scan_files: not a point format");
  }
  return files;
}

}  // namespace adasplats
