// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrays/npz.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/pcd/pcd_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {

namespace {

/// By rows.
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

/// The names of scan_columns() as those of whole arrays.
std::string array_name(std::string_view column) {
  if (column == "intensity") return "intensities";
  if (column == "return_index") return "return_indices";
  return std::string(column) + "s";
}

constexpr std::uint16_t kMostLasClass = 255;

/// What LAS has fields of its own for.
struct LasFields {
  std::vector<std::uint16_t> intensities;
  std::vector<std::uint8_t> classes, return_numbers, returns;
  std::vector<double> times;

  LasFields(const Scan& scan, double full_intensity) : returns(returns_of_firings(scan)) {
    for (const float value : scan.intensities) {
      const double share = std::isnan(value) ? 0.0 : static_cast<double>(value) / full_intensity;
      intensities.push_back(
          static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0))));
    }
    // Never classified is the truth of a field that cannot hold the class; `label` can.
    for (const std::uint16_t id : scan.classes)
      classes.push_back(id > kMostLasClass ? std::uint8_t{0} : static_cast<std::uint8_t>(id));
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const int number = scan.return_indices.empty() ? 1 : scan.return_indices[i] + 1;
      return_numbers.push_back(static_cast<std::uint8_t>(number));
    }
    for (const float time : scan.times_s) times.push_back(scan.time_s + static_cast<double>(time));
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

}  // namespace

void write_scan_ply(const std::filesystem::path& path, const Scan& scan) {
  write_ply(path, scan.size(), scan_columns(scan));
}

void write_scan_npy(const std::filesystem::path& path, const Scan& scan) {
  write_npy(path, points_with_intensity(scan), scan.size(), 4);
  std::filesystem::path labels_path = path;
  labels_path.replace_filename(path.stem().string() + "_label" + path.extension().string());
  write_npy(labels_path, packed_labels(scan));
}

void write_scan_npz(const std::filesystem::path& path, const Scan& scan) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  std::vector<NamedArray> arrays = {
      {"points", {ColumnType::f32, {scan.size(), 3}, scan.positions.data()}}};
  const std::vector<ColumnView> columns = scan_columns(scan);
  constexpr std::size_t kPosition = 3;  // x, y and z are "points"
  for (std::size_t k = kPosition; k < columns.size(); ++k)
    arrays.push_back(
        {array_name(columns[k].name), {columns[k].type, {scan.size()}, columns[k].data}});
  const std::array<double, 16> pose = matrix_of(scan.world_from_sensor);
  arrays.push_back({"world_from_sensor", {ColumnType::f64, {4, 4}, pose.data()}});
  arrays.push_back({"time", {ColumnType::f64, {1}, &scan.time_s}});
  write_npz(path, arrays);
}

void write_scan_pcd(const std::filesystem::path& path, const Scan& scan) {
  write_pcd(path, scan.size(), scan_columns(scan), viewpoint_of(scan.world_from_sensor));
}

void write_scan_las(const std::filesystem::path& path, const Scan& scan, double full_intensity) {
  const LasFields fields(scan, full_intensity);
  std::vector<ColumnView> columns = fields.columns();
  for (ColumnView column : scan_columns(scan)) {
    if (column.name == "time" || column.name == "return_index") continue;
    if (column.name == "intensity") column.name = "intensity_value";
    columns.push_back(column);
  }
  write_las(path, scan.size(), columns);
}

}  // namespace adasplats
