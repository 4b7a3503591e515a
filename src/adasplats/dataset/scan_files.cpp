// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Single scans as files.

#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/io/npy.h"
#include "adasplats/io/ply.h"

namespace adasplats {

namespace {

template <class T>
ColumnView column_of(std::string_view name, ColumnType type, const std::vector<T>& values) {
  return {name, type, values.data(), sizeof(T)};
}

}  // namespace

void write_scan_ply(const std::filesystem::path& path, const Scan& scan) {
  // An empty scan has no first point to take addresses from.
  const Vec3f* const first = scan.positions.data();
  std::vector<ColumnView> columns = {
      {"x", ColumnType::f32, first != nullptr ? &first->x : nullptr, sizeof(Vec3f)},
      {"y", ColumnType::f32, first != nullptr ? &first->y : nullptr, sizeof(Vec3f)},
      {"z", ColumnType::f32, first != nullptr ? &first->z : nullptr, sizeof(Vec3f)}};
  if (!scan.intensities.empty())
    columns.push_back(column_of("intensity", ColumnType::f32, scan.intensities));
  if (!scan.classes.empty()) columns.push_back(column_of("label", ColumnType::u16, scan.classes));
  if (!scan.instances.empty())
    columns.push_back(column_of("instance", ColumnType::u16, scan.instances));
  columns.push_back(column_of("ring", ColumnType::u16, scan.rings));
  columns.push_back(column_of("time", ColumnType::f32, scan.times_s));
  columns.push_back(column_of("range", ColumnType::f32, scan.ranges_m));
  write_ply(path, scan.size(), columns);
}

void write_scan_npy(const std::filesystem::path& path, const Scan& scan) {
  write_npy(path, points_with_intensity(scan), scan.size(), 4);
  std::filesystem::path labels_path = path;
  labels_path.replace_filename(path.stem().string() + "_label" + path.extension().string());
  write_npy(labels_path, packed_labels(scan));
}

}  // namespace adasplats
